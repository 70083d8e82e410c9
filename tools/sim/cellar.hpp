// SPDX-License-Identifier: Apache-2.0
// A level under ground: streets with walls and a ceiling, halls between them, ramps down to it, and a square above.
#pragma once

#include <algorithm>

#include "tools/sim/polygon.hpp"

namespace mapweld::sim {

struct Cellar {
  Polyline outline;                          // of its level part: a rectangle, counter-clockwise
  Vec2d out = Vec2d::UnitX();                // of unit length: the way up its ramps
  double edge_m = 0;                         // along `out`: where the level part ends and the ramps begin
  double ramp_m = 0;                         // how long they are, along `out`
  double depth_m = 0;                        // of its floor under the ground
  static constexpr double kCeiling_m = 3.0;  // above its floor

  // How far under the ground a street runs at `p`. Steepest in the middle of a ramp: 1.5 depth_m / ramp_m.
  [[nodiscard]] double Depth(const Vec2d& p) const {
    const double u = Share(p);
    return depth_m * (1 - u * u * (3 - 2 * u));
  }
  // Metres that the street rises per metre, by direction.
  [[nodiscard]] Vec2d Slope(const Vec2d& p) const {
    const double u = Share(p);
    return depth_m * 6 * u * (1 - u) / ramp_m * out;
  }

 private:
  // 0 where it is deep, 1 where it is over.
  [[nodiscard]] double Share(const Vec2d& p) const { return std::clamp((out.dot(p) - edge_m) / ramp_m, 0.0, 1.0); }
};

}  // namespace mapweld::sim
