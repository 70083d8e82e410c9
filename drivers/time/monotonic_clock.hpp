// SPDX-License-Identifier: Apache-2.0
// The one place where the agent asks the operating system for the time. CLOCK_MONOTONIC: no jumps, no leap seconds.
#pragma once

#include "core/base/time.hpp"

namespace mapweld::time {

TimeNs MonotonicNow();

// Both clocks read one after the other, so that a wall-clock stamp of the kernel can be moved to the monotonic clock.
struct ClockPair {
  TimeNs monotonic;
  TimeNs realtime;
};
ClockPair ReadClocks();

}  // namespace mapweld::time
