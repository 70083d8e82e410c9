// SPDX-License-Identifier: Apache-2.0
#include "drivers/time/monotonic_clock.hpp"

#include <ctime>

namespace mapweld::time {
namespace {

TimeNs Read(clockid_t id) {
  timespec now{};
  // Cannot fail for the two clocks asked for here; a zero time would be refused downstream as going backwards.
  (void)::clock_gettime(id, &now);
  return {static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + static_cast<std::int64_t>(now.tv_nsec)};
}

}  // namespace

TimeNs MonotonicNow() {
  return Read(CLOCK_MONOTONIC);
}

ClockPair ReadClocks() {
  return {Read(CLOCK_MONOTONIC), Read(CLOCK_REALTIME)};
}

}  // namespace mapweld::time
