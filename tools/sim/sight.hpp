// SPDX-License-Identifier: Apache-2.0
// The part of a town that can be seen from some routes: only this part is built.
#pragma once

#include <vector>

#include "tools/sim/polygon.hpp"

namespace mapweld::sim {

class Sight {
 public:
  static constexpr double kReach_m = 160;  // beyond the range of the sensor, so that no house at its edge is cut
  static constexpr double kCell_m = 20;

  // All squares of kCell_m within `reach_m` of a line. Cost: (reach / cell)^2 per 10 m of line; memory: one byte per
  // square of the lines' bounding box.
  explicit Sight(const std::vector<const Polyline*>& lines, double reach_m = kReach_m);

  [[nodiscard]] bool Contains(const Vec2d& p) const;
  // Lower left corners of all its squares, row by row.
  [[nodiscard]] std::vector<Vec2d> Cells() const;

 private:
  Box2 box_;
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<char> seen_;
};

}  // namespace mapweld::sim
