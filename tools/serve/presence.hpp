// SPDX-License-Identifier: Apache-2.0
// Which agents are there now, and which ids are used by two of them at once.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <set>

#include "tools/serve/drive_id.hpp"

namespace mapweld::serve {

// An agent sends health ten times a second. One that has been silent for kSilence is gone: nobody waits for it, and
// when it returns everything goes on. One that has started again no longer has what it recorded before.
class Presence {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kSilence{5};
  // A drive that speaks this long after a later start of the same agent has not been overtaken on the way.
  static constexpr std::chrono::seconds kOvertaking{2};

  void Heard(const DriveId& id, Clock::time_point now);
  [[nodiscard]] bool IsHere(const DriveId& id, Clock::time_point now) const;
  // Agents that speak with two boot counts at a time: two vehicles with one id.
  [[nodiscard]] const std::set<std::int16_t>& twins() const { return twins_; }

 private:
  struct Times {
    Clock::time_point first;
    Clock::time_point last;
  };
  std::map<DriveId, Times> heard_;
  std::set<std::int16_t> twins_;
};

}  // namespace mapweld::serve
