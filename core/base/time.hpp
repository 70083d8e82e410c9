// SPDX-License-Identifier: Apache-2.0
// Points and spans of time in integer nanoseconds. Core never asks for the time: every stamp comes in with the data.
#pragma once

#include <compare>
#include <cstdint>

namespace mapweld {

struct DurationNs {
  std::int64_t ns = 0;
  constexpr auto operator<=>(const DurationNs&) const = default;
  [[nodiscard]] constexpr double Seconds() const { return static_cast<double>(ns) * 1e-9; }
};

// One agent-local epoch for all sensors (see drivers/time). Not wall-clock time.
struct TimeNs {
  std::int64_t ns = 0;
  constexpr auto operator<=>(const TimeNs&) const = default;
};

constexpr DurationNs operator-(TimeNs a, TimeNs b) {
  return {a.ns - b.ns};
}
constexpr TimeNs operator+(TimeNs t, DurationNs d) {
  return {t.ns + d.ns};
}
constexpr TimeNs operator-(TimeNs t, DurationNs d) {
  return {t.ns - d.ns};
}
constexpr DurationNs Milliseconds(std::int64_t ms) {
  return {ms * 1'000'000};
}
constexpr DurationNs FromSeconds(double s) {
  return {static_cast<std::int64_t>(s * 1e9)};
}

}  // namespace mapweld
