// SPDX-License-Identifier: Apache-2.0
// Where along the streets there is room to put something.
#pragma once

#include "tools/sim/plane_index.hpp"
#include "tools/sim/sight.hpp"
#include "tools/sim/town.hpp"

namespace mapweld::sim {

// Keeps pieces off every carriageway, out of every house and away from junctions. Refers to the town's buildings.
class Clearance {
 public:
  Clearance(const Town& town, const Sight& sight);
  // True when a disc of this radius stands free.
  [[nodiscard]] bool IsFree(const Vec2d& p, double radius) const;

 private:
  struct Piece {
    Vec2d from;
    Vec2d to;
    double half_width_m;
  };
  static constexpr double kReach_m = 20;  // no clearance asked for is wider, half a carriageway included
  PlaneIndex<Piece> pieces_;
  PlaneIndex<Vec2d> junctions_;
  PlaneIndex<const Building*> buildings_;
};

}  // namespace mapweld::sim
