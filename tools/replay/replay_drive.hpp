// SPDX-License-Identifier: Apache-2.0
// Plays a recording to an agent without losing anything: it never has more under way than fits the agent's socket
// buffers, judged by the counters in the agent's health messages.
#pragma once

#include <cstdint>
#include <functional>

#include "tools/replay/agent_link.hpp"
#include "tools/replay/recording.hpp"

namespace mapweld::replay {

struct ReplayLimits {
  std::int64_t packets_under_way = 64;
  std::int64_t frames_under_way = 128;
  double first_health_s = 30;
  double no_progress_s = 10;
  double realtime_quiet_s = 2;  // real-time replays may lose data: this long without news counts as consumed
  double end_repeat_s = 0.5;
  double end_s = 60;
};

struct ReplaySummary {
  std::int64_t packets = 0;
  std::int64_t frames = 0;
  std::int64_t packets_lost = 0;  // real-time replays only
  std::int64_t frames_lost = 0;
  double recorded_s = 0;
  double wall_s = 0;  // from the first datagram to the last one consumed
};

// Waits for the agent, plays, ends the drive and waits until the agent has ended it. `progress` gets recorded seconds.
// Throws std::runtime_error when the agent is silent, has ended before, restarts, or takes nothing for too long.
ReplaySummary ReplayDrive(EventSource& source, AgentLink& link, bool realtime, const ReplayLimits& limits,
                          const std::function<void(double)>& progress);

}  // namespace mapweld::replay
