// SPDX-License-Identifier: Apache-2.0
// Gets what is missing: asks agents for keyframes that were lost and submaps that are wanted, again and again until
// they are there, a bounded number at a time and within a byte budget. Only agents that are here are asked.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <vector>

#include "tools/serve/fleet_link.hpp"

namespace mapweld::serve {

class Requester {
 public:
  using Clock = std::chrono::steady_clock;

  struct Submap {
    DriveId id;
    std::int32_t keyframe = 0;
  };

  // bytes_per_s: of submaps, from all agents together; 0: as fast as the agents allow themselves.
  explicit Requester(FleetLink* link, double bytes_per_s = 0) : link_(link), bytes_per_s_(bytes_per_s) {}

  // The submaps wanted from now on, most valuable first; what was wanted before and is not listed is forgotten.
  void Want(std::vector<Submap> submaps) { wanted_ = std::move(submaps); }
  // Sends what is due. Call often; costs little when nothing is missing.
  void Step(Clock::time_point now);
  // Wanted submaps that have not arrived and whose agent is here.
  [[nodiscard]] std::size_t outstanding();
  // Is there anything to ask for soon?
  [[nodiscard]] bool busy() const { return busy_; }

 private:
  struct Pace {
    Clock::time_point last;
    std::size_t missing = 0;
  };
  // Ask when there was progress since the last time, or after a pause long enough for an answer to have been lost.
  static bool IsDue(std::size_t missing, Clock::time_point now, const Pace& pace);

  void RequestKeyframes(Clock::time_point now);
  void RequestSubmaps(Clock::time_point now);

  FleetLink* link_;
  double bytes_per_s_;
  double allowance_ = 0;  // bytes that may be asked for now
  Clock::time_point last_step_{};
  bool busy_ = false;
  std::vector<Submap> wanted_;
  std::map<DriveId, Pace> keyframe_pace_;
  std::map<DriveId, Pace> submap_pace_;
};

}  // namespace mapweld::serve
