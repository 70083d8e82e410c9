// SPDX-License-Identifier: Apache-2.0
// Which drives truly share a stretch of street, and how much of it.
#pragma once

#include <vector>

#include "tools/sim/lane_path.hpp"

namespace mapweld::sim {

inline constexpr double kTogether_m = 10;  // two places on two drives that are this close are one place

struct TrueOverlap {
  int a = 0;  // indices of the drives, a < b
  int b = 0;
  double same_direction_m = 0;      // of drive a's path, with b passing the same place the same way (within 60 degrees)
  double opposite_direction_m = 0;  // the other way
  double crossing_m = 0;            // at any other angle
  [[nodiscard]] double Shared() const { return same_direction_m + opposite_direction_m; }
};

// Every pair of drives that come within kTogether_m of each other anywhere, in the order of (a, b).
// Cost: one step per metre of path and drive near it.
std::vector<TrueOverlap> FindTrueOverlaps(const std::vector<LanePath>& drives);

}  // namespace mapweld::sim
