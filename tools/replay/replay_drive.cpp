// SPDX-License-Identifier: Apache-2.0
#include "tools/replay/replay_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "drivers/can/xsens_table.hpp"

namespace mapweld::replay {
namespace {

constexpr std::int8_t kModeEnded = 4;

class Player {
 public:
  Player(AgentLink& link, const ReplayLimits& limits) : link_(link), limits_(limits) {}

  void WaitForAgent() {
    const double deadline = link_.Now_s() + limits_.first_health_s;
    while (!link_.health()) {
      if (link_.Now_s() >= deadline) {
        throw std::runtime_error(fmt::format(
            "no health message within {:.0f} s; check that the agent runs with this id and the same LCM URL",
            limits_.first_health_s));
      }
      link_.Wait(0.1);
    }
    first_ = *link_.health();
    if (first_.mode == kModeEnded) {
      throw std::runtime_error("the agent has already ended its drive; restart it before the next one");
    }
    last_progress_s_ = link_.Now_s();
  }

  void Send(const Event& event) {
    if (!event.lidar.empty()) {
      link_.SendLidar(event.lidar);
      ++packets_;
    } else {
      link_.SendCan(event.frame);
      ++frames_;
      if (CountedByAgent(event.frame)) ++counted_frames_;
    }
  }

  // Until there is room for one more of each kind.
  void WaitForRoom() {
    if (PacketsUnderWay() * 2 >= limits_.packets_under_way || FramesUnderWay() * 2 >= limits_.frames_under_way) {
      link_.Wait(0);
    }
    WaitUntil(
        [&] { return PacketsUnderWay() < limits_.packets_under_way && FramesUnderWay() < limits_.frames_under_way; });
  }

  void WaitForAll() {
    WaitUntil([&] { return PacketsUnderWay() <= 0 && FramesUnderWay() <= 0; });
  }

  // Real time: what the agent has not reported by the time it falls silent was lost.
  void WaitUntilQuiet() {
    NoteProgress();
    last_progress_s_ = link_.Now_s();
    while ((PacketsUnderWay() > 0 || FramesUnderWay() > 0) &&
           link_.Now_s() - last_progress_s_ < limits_.realtime_quiet_s) {
      link_.Wait(0.1);
      NoteProgress();
    }
  }

  void EndDrive() {
    const double deadline = link_.Now_s() + limits_.end_s;
    double next_command_s = link_.Now_s();
    while (link_.health()->mode != kModeEnded) {
      if (link_.Now_s() >= deadline) {
        throw std::runtime_error(
            fmt::format("the agent has not ended its drive within {:.0f} s of being told to; see "
                        "its own messages for what it is doing",
                        limits_.end_s));
      }
      if (link_.Now_s() >= next_command_s) {
        link_.SendEndDrive();
        next_command_s = link_.Now_s() + limits_.end_repeat_s;
      }
      link_.Wait(0.05);
    }
  }

  [[nodiscard]] std::int64_t packets() const { return packets_; }
  [[nodiscard]] std::int64_t frames() const { return frames_; }
  [[nodiscard]] std::int64_t PacketsUnderWay() const {
    const auto& now = *link_.health();
    return packets_ - (now.lidar_packets + now.lidar_rejected - first_.lidar_packets - first_.lidar_rejected);
  }
  [[nodiscard]] std::int64_t FramesUnderWay() const {
    return counted_frames_ - (link_.health()->can_frames - first_.can_frames);
  }

 private:
  // The agent lets the kernel filter the bus and counts what passes.
  static bool CountedByAgent(const can::CanFrame& frame) {
    return !frame.extended &&
           std::find(can::kXsensWantedIds.begin(), can::kXsensWantedIds.end(), frame.id) != can::kXsensWantedIds.end();
  }

  void NoteProgress() {
    const auto& now = *link_.health();
    if (now.epoch != first_.epoch) {
      throw std::runtime_error(fmt::format(
          "the agent restarted during the replay (boot {} became {}); see its own messages", first_.epoch, now.epoch));
    }
    const std::int64_t consumed = now.lidar_packets + now.lidar_rejected + now.can_frames;
    if (consumed == consumed_) return;
    consumed_ = consumed;
    last_progress_s_ = link_.Now_s();
  }

  template <typename Done>
  void WaitUntil(Done done) {
    NoteProgress();
    if (done()) return;
    last_progress_s_ = link_.Now_s();
    for (NoteProgress(); !done(); NoteProgress()) {
      if (link_.Now_s() - last_progress_s_ >= limits_.no_progress_s) {
        throw std::runtime_error(
            fmt::format("the agent has taken nothing for {:.0f} s: {} LiDAR packets and {} CAN frames are missing, its "
                        "kernel dropped {}; check the LiDAR port, the CAN interface and that only one replay feeds it",
                        limits_.no_progress_s, PacketsUnderWay(), FramesUnderWay(),
                        link_.health()->kernel_drops - first_.kernel_drops));
      }
      link_.Wait(0.1);
    }
  }

  AgentLink& link_;
  const ReplayLimits& limits_;
  mapweldlcm::health_t first_{};
  std::int64_t packets_ = 0;
  std::int64_t frames_ = 0;
  std::int64_t counted_frames_ = 0;
  std::int64_t consumed_ = 0;
  double last_progress_s_ = 0;
};

}  // namespace

ReplaySummary ReplayDrive(EventSource& source, AgentLink& link, bool realtime, const ReplayLimits& limits,
                          const std::function<void(double)>& progress) {
  Player player(link, limits);
  player.WaitForAgent();
  const double begin_s = link.Now_s();
  std::int64_t first_stamp_ns = 0;
  ReplaySummary summary;
  Event event;
  while (source.Next(&event)) {
    if (player.packets() + player.frames() == 0) first_stamp_ns = event.stamp_ns;
    summary.recorded_s = static_cast<double>(event.stamp_ns - first_stamp_ns) * 1e-9;
    if (realtime) {
      link.SleepUntil(begin_s + summary.recorded_s);
    } else {
      player.WaitForRoom();
    }
    player.Send(event);
    progress(summary.recorded_s);
  }
  if (realtime) {
    player.WaitUntilQuiet();
    summary.packets_lost = std::max<std::int64_t>(0, player.PacketsUnderWay());
    summary.frames_lost = std::max<std::int64_t>(0, player.FramesUnderWay());
  } else {
    player.WaitForAll();
  }
  summary.wall_s = link.Now_s() - begin_s;
  summary.packets = player.packets();
  summary.frames = player.frames();
  player.EndDrive();
  return summary;
}

}  // namespace mapweld::replay
