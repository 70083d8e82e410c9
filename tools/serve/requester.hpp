// SPDX-License-Identifier: Apache-2.0
// Gets what is missing: asks agents for keyframes that were lost and submaps that are wanted, again and again until
// they are there, a bounded number at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "tools/serve/fleet_link.hpp"

namespace mapweld::serve {

class Requester {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Requester(FleetLink* link) : link_(link) {}

  // The submaps wanted from now on, most valuable first; what was wanted before and is not listed is forgotten.
  void Want(const DriveId& id, const std::vector<std::int32_t>& keyframes) { wanted_[id] = keyframes; }
  // Sends what is due. Call often; costs little when nothing is missing.
  void Step(Clock::time_point now);
  // Wanted submaps that have not arrived.
  [[nodiscard]] std::size_t outstanding();

 private:
  struct Pace {
    Clock::time_point last;
    std::size_t missing = 0;
  };
  // Asks when there was progress since the last time, or after a pause long enough for an answer to have been lost.
  static bool IsDue(std::size_t missing, Clock::time_point now, Pace* pace);

  FleetLink* link_;
  std::map<DriveId, std::vector<std::int32_t>> wanted_;
  std::map<DriveId, Pace> keyframe_pace_;
  std::map<DriveId, Pace> submap_pace_;
};

}  // namespace mapweld::serve
