// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/agent.hpp"

#include <sys/epoll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "drivers/messages/channel.hpp"
#include "drivers/messages/codec.hpp"
#include "drivers/time/monotonic_clock.hpp"
#include "firmware-like/heap_seal.hpp"

namespace mapweld::executive {
Agent::Agent(const Options& options, std::int32_t epoch)
    : options_(options),
      telemetry_({static_cast<std::int16_t>(options.agent_id), epoch}, &bus_),
      answers_(options.answer_bytes_per_s, &spool_, &telemetry_),
      lidar_(options),
      imu_(options),
      pipeline_(options.agent, this) {}

Agent::~Agent() {
  if (epoll_fd_ >= 0) close(epoll_fd_);
  if (signal_fd_ >= 0) close(signal_fd_);
}

bool Agent::Boot(std::span<char> message) {
  const auto fail = [&](const char* format, auto... arguments) {
    std::snprintf(message.data(), message.size(), format, arguments...);
    return false;
  };
  char path[512];
  std::snprintf(path, sizeof(path), "%s/spool", options_.state_dir);
  if (spool_.Open(path, static_cast<std::uint64_t>(options_.spool_bytes)) != Status::kOk) {
    return fail("cannot reserve %lld MiB for the spool %s: %s; free the disk or give a smaller --spool-mib",
                static_cast<long long>(options_.spool_bytes >> 20), path, std::strerror(errno));
  }
  messages::ChannelBuffer buffer;
  const auto prefix = messages::FormatAgentPrefix(&buffer, options_.agent_id);
  if (!prefix.ok() || bus_.Open(options_.lcm_url, prefix.value()) != Status::kOk) {
    return fail(
        "cannot join the LCM network %s: %s; a machine without a route for multicast needs "
        "'ip route add 224.0.0.0/4 dev lo'",
        options_.lcm_url, std::strerror(errno));
  }
  if (const Status status = lidar_.LoadCalibration(options_); status != Status::kOk) {
    return fail("cannot use the LiDAR calibration %s: %s", options_.lidar_calibration_path,
                status == Status::kIo ? std::strerror(errno) : "it is not the file of this model; see --lidar");
  }
  const Status lidar = lidar_.Open(options_);
  if (lidar != Status::kOk) {
    return fail("cannot listen for the LiDAR on UDP port %d: %s; stop the other program or give another --lidar-port",
                static_cast<int>(options_.lidar_port),
                lidar == Status::kFull ? "another program has it" : std::strerror(errno));
  }
  if (const Status status = imu_.LoadDescription(options_); status != Status::kOk) {
    const char* why = status == Status::kIo ? std::strerror(errno)
                      : status == Status::kEmpty
                          ? "a signal of --imu-signals is not in it, or more than once"
                          : "a signal of --imu-signals is not described as docs/wire.md says, or has an unknown unit";
    return fail("cannot use the IMU description %s: %s", options_.imu_dbc_path, why);
  }
  if (imu_.Open(options_) != Status::kOk) {
    if (options_.candump_path != nullptr) {
      return fail("cannot read the CAN log %s: %s", options_.candump_path, std::strerror(errno));
    }
    if (errno == EAFNOSUPPORT) {
      return fail(
          "cannot open the CAN interface %s: this kernel has no CAN; load its modules (can, can-raw) or read a "
          "log with --candump",
          options_.can_interface);
    }
    return fail("cannot open the CAN interface %s: %s; bring it up with 'ip link set %s up type can bitrate 500000'",
                options_.can_interface, std::strerror(errno), options_.can_interface);
  }
  if (!OpenLoop()) return fail("cannot wait for events: %s", std::strerror(errno));
  watchdog_.Open();
  mode_ = Mode::kAlign;
  return true;
}

bool Agent::OpenLoop() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  if (sigprocmask(SIG_BLOCK, &signals, nullptr) != 0) return false;
  signal_fd_ = signalfd(-1, &signals, SFD_NONBLOCK | SFD_CLOEXEC);
  epoll_fd_ = epoll_create1(EPOLL_CLOEXEC);
  return signal_fd_ >= 0 && epoll_fd_ >= 0 && Watch(signal_fd_) && Watch(bus_.fd()) && Watch(lidar_.fd()) &&
         (imu_.poll_fd() < 0 || Watch(imu_.poll_fd()));
}

bool Agent::Watch(int fd) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.fd = fd;
  return epoll_ctl(epoll_fd_, EPOLL_CTL_ADD, fd, &event) == 0;
}

void Agent::Run() {
  watchdog_.Ready();
  while (!stop_) {
    const bool more_answers = answers_.Step(time::MonotonicNow());
    PollOnce(more_answers ? 1 : 20);
    Housekeep(time::MonotonicNow());
  }
  watchdog_.Stopping();
  EndDrive();
  if (spool_.Sync() != Status::kOk) mode_ = Mode::kDegraded;
  PublishHealth();
}

void Agent::PollOnce(int timeout_ms) {
  std::array<epoll_event, 8> events{};
  const int n = epoll_wait(epoll_fd_, events.data(), static_cast<int>(events.size()), timeout_ms);
  for (int i = 0; i < n; ++i) {
    const int fd = events[static_cast<std::size_t>(i)].data.fd;
    if (fd == signal_fd_) stop_ = true;
    if (fd == lidar_.fd()) TakeLidar();
    if (fd == imu_.poll_fd()) imu_.Drain(&pipeline_);
    if (fd == bus_.fd()) TakeBus();
  }
}

void Agent::TakeLidar() {
  std::span<const lidar::Datagram> datagrams;
  if (lidar_.Receive(&datagrams) != Status::kOk) return;
  for (const lidar::Datagram& datagram : datagrams) TakePacket(datagram);
}

void Agent::TakePacket(const lidar::Datagram& datagram) {
  if (mode_ == Mode::kEnded) return;
  if (!imu_.has_sample()) imu_.ReadUntil({INT64_MIN}, &pipeline_);
  if (imu_.has_sample()) lidar_.clock().Anchor(imu_.newest());
  if (lidar_.Decode(datagram, &packet_) != Status::kOk) return;
  imu_.ReadUntil(packet_.t, &pipeline_);

  const TimeNs begin = time::MonotonicNow();
  const std::uint64_t scans = pipeline_.counters().scans;
  pipeline_.OnPacket(packet_);
  if (pipeline_.counters().scans != scans) {
    const double ms = (time::MonotonicNow() - begin).Seconds() * 1e3;
    scan_ms_sum_ += ms;
    scan_ms_max_ = std::max(scan_ms_max_, ms);
  }
  sensor_time_ = packet_.t;
  if (mode_ == Mode::kAlign && pipeline_.aligned()) mode_ = Mode::kRun;
  if (sensor_health_.Due(sensor_time_)) PublishHealth();
}

void Agent::TakeBus() {
  const auto deliver = [](void* agent, std::string_view channel, std::span<const std::uint8_t> payload) {
    static_cast<Agent*>(agent)->OnMessage(channel, payload);
  };
  (void)bus_.Receive({deliver, this});
}

void Agent::OnMessage(std::string_view channel, std::span<const std::uint8_t> payload) {
  const auto parsed = messages::ParseChannel(channel);
  if (!parsed.ok()) return;
  // false, and counted: another type, another version of it, or a field out of range.
  const auto decode = [&](auto* message) {
    const bool good = messages::Decode(payload, message) == Status::kOk;
    messages_refused_ += good ? 0 : 1;
    return good;
  };
  mapweldlcm::request_t request;
  mapweldlcm::global_pose_t pose;
  mapweldlcm::command_t command;
  switch (parsed.value().kind) {
    case messages::Kind::kRequest:
      if (decode(&request)) answers_.Add(request);
      break;
    case messages::Kind::kGlobalPose:
      if (decode(&pose) && pose.epoch == telemetry_.identity().epoch) OnGlobalPose(pose);
      break;
    case messages::Kind::kCommand:
      if (!decode(&command)) break;  // the only command there is: end of the drive
      EndDrive();
      PublishHealth();
      break;
    default:
      break;  // what agents say
  }
}

void Agent::OnGlobalPose(const mapweldlcm::global_pose_t& message) {
  correct::MergedPose pose;
  pose.keyframe = message.keyframe;
  pose.group = message.group;
  pose.revision = message.revision;
  pose.merged_T_body.t = {message.merged_t_body[0], message.merged_t_body[1], message.merged_t_body[2]};
  pose.merged_T_body.q = {message.merged_q_body[3], message.merged_q_body[0], message.merged_q_body[1],
                          message.merged_q_body[2]};
  pose.sigma_m = static_cast<double>(message.sigma_m);
  pose.sigma_rad = static_cast<double>(message.sigma_rad);
  (void)pipeline_.OnMergedPose(pose);  // too old or of another revision: the next one will do
}

void Agent::EndDrive() {
  if (mode_ == Mode::kEnded) return;
  imu_.ReadUntil({INT64_MAX}, &pipeline_);
  imu_.Drain(&pipeline_);
  pipeline_.OnDriveEnd();
  mode_ = Mode::kEnded;
}

void Agent::OnPose(const pipeline::PoseOutput& pose) {
  if (mode_ == Mode::kRun || mode_ == Mode::kDegraded) {
    mode_ = pose.odometry.degenerate || !pose.odometry.corrected ? Mode::kDegraded : Mode::kRun;
  }
  telemetry_.PublishPose(pose);
}

void Agent::OnKeyframe(const pipeline::KeyframeOutput& keyframe) {
  const auto encoded = telemetry_.PublishKeyframe(keyframe);
  // What does not fit the spool is counted there and cannot be sent again; the odometry goes on.
  const auto key = [&](RecordKind kind) {
    return spool::RecordSpool::Key{telemetry_.identity().epoch, static_cast<std::uint8_t>(kind), keyframe.index};
  };
  (void)spool_.Append(key(RecordKind::kKeyframe), encoded);
  (void)spool_.Append(key(RecordKind::kSubmap), keyframe.encoded);
  spool_dirty_ = true;
}

void Agent::Housekeep(TimeNs now) {
  if (idle_health_.Due(now)) PublishHealth();
  if (replug_.Due(now)) imu_.Reconnect();
  if (remind_.Due(now)) answers_.RemindOfEarlierDrives();
  if (!slow_.Due(now)) return;
  watchdog_.Alive();
  if (spool_dirty_ && spool_.Sync() == Status::kOk) spool_dirty_ = false;
}

void Agent::PublishHealth() {
  idle_health_.Restart(time::MonotonicNow());
  const pipeline::AgentCounters& counters = pipeline_.counters();
  const auto count = [](std::uint64_t value) { return static_cast<std::int64_t>(value); };
  mapweldlcm::health_t health{};
  health.t_ns = std::max<std::int64_t>(sensor_time_.ns, 0);
  health.mode = static_cast<std::int8_t>(mode_);
  health.heap_calls = HeapCallsAfterSeal();
  health.lidar_packets = count(lidar_.packets());
  health.lidar_rejected = count(lidar_.rejected());
  health.can_frames = count(imu_.frames());
  health.imu_samples = count(imu_.samples());
  health.imu_rejected = count(imu_.rejected());
  health.kernel_drops = count(lidar_.kernel_drops() + imu_.kernel_drops() + bus_.counters().kernel_drops);
  health.scans = count(counters.scans);
  health.scans_dropped = count(counters.scans_dropped);
  health.keyframes = static_cast<std::int32_t>(counters.keyframes);
  health.submaps_sent = answers_.submaps_sent();
  health.bytes_sent = count(bus_.counters().sent_bytes);
  health.bus_rejected = count(bus_.Rejected() + messages_refused_);
  health.scan_ms_mean =
      static_cast<float>(counters.scans > 0 ? scan_ms_sum_ / static_cast<double>(counters.scans) : 0.0);
  health.scan_ms_max = static_cast<float>(scan_ms_max_);
  health.path_m = static_cast<float>(pipeline_.path_m());
  telemetry_.PublishHealth(&health);
}

}  // namespace mapweld::executive
