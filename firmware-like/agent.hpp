// SPDX-License-Identifier: Apache-2.0
// The executive: sensors in, pipeline, messages out, in one thread around one epoll.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/pipeline/agent_pipeline.hpp"
#include "core/sensor/lidar_packet.hpp"
#include "drivers/bus/udpm_bus.hpp"
#include "drivers/spool/record_spool.hpp"
#include "firmware-like/answer_queue.hpp"
#include "firmware-like/imu_source.hpp"
#include "firmware-like/lidar_source.hpp"
#include "firmware-like/options.hpp"
#include "firmware-like/rate_group.hpp"
#include "firmware-like/telemetry.hpp"
#include "firmware-like/watchdog.hpp"

namespace mapweld::executive {

enum class Mode : std::int8_t { kBoot = 0, kAlign = 1, kRun = 2, kDegraded = 3, kEnded = 4 };

// Some 30 MB: lives in AgentMemory only.
class Agent final : private pipeline::AgentSink {
 public:
  Agent(const Options& options, std::int32_t epoch);
  ~Agent();
  Agent(const Agent&) = delete;
  Agent& operator=(const Agent&) = delete;

  // Opens sensors, bus and spool. On failure one sentence, with the remedy, is in `message`.
  bool Boot(std::span<char> message);
  // Until SIGTERM or SIGINT: then the drive is ended, everything is published and the spool is on the disk.
  void Run();

  [[nodiscard]] const pipeline::AgentPipeline& pipeline() const { return pipeline_; }

 private:
  void OnPose(const pipeline::PoseOutput& pose) override;
  void OnKeyframe(const pipeline::KeyframeOutput& keyframe) override;

  bool OpenLoop();
  bool Watch(int fd);
  void PollOnce(int timeout_ms);
  void TakeLidar();
  void TakePacket(const lidar::Datagram& datagram);
  void TakeBus();
  void OnMessage(std::string_view channel, std::span<const std::uint8_t> payload);
  void OnGlobalPose(const mapweldlcm::global_pose_t& message);
  void EndDrive();
  void Housekeep(TimeNs now);
  void PublishHealth();

  Options options_;
  Mode mode_ = Mode::kBoot;
  bool stop_ = false;
  int epoll_fd_ = -1;
  int signal_fd_ = -1;

  bus::UdpmBus bus_;
  spool::RecordSpool spool_;
  Telemetry telemetry_;
  AnswerQueue answers_;
  Watchdog watchdog_;

  LidarSource lidar_;
  sensor::LidarPacket packet_;
  ImuSource imu_;
  pipeline::AgentPipeline pipeline_;

  TimeNs sensor_time_;
  double scan_ms_sum_ = 0;
  double scan_ms_max_ = 0;
  bool spool_dirty_ = false;
  std::uint64_t messages_refused_ = 0;
  RateGroup sensor_health_{Milliseconds(50)};  // of sensor time
  RateGroup idle_health_{Milliseconds(100)};   // of real time
  RateGroup replug_{Milliseconds(200)};        // looks for an interface that was unplugged
  RateGroup remind_{AnswerQueue::kRemindEvery};
  RateGroup slow_{Milliseconds(1000)};  // spool to disk, watchdog
};

}  // namespace mapweld::executive
