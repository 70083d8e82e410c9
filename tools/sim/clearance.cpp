// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/clearance.hpp"

#include <initializer_list>
#include <unordered_map>

namespace mapweld::sim {
namespace {

Box2 Around(std::initializer_list<Vec2d> points, double margin) {
  Box2 box;
  for (const Vec2d& p : points) box.Extend(p);
  return box.Grown(margin);
}

}  // namespace

Clearance::Clearance(const Town& town, const Sight& sight) {
  std::unordered_map<std::int64_t, int> ends;
  for (const Road& road : town.roads) {
    for (std::size_t i = 0; i < road.nodes.size(); ++i) {
      int& n = ends[road.nodes[i]];
      const int before = n;
      n += (i > 0 ? 1 : 0) + (i + 1 < road.nodes.size() ? 1 : 0);
      if (before < 3 && n >= 3 && sight.Contains(road.line[i]))
        junctions_.Add(Around({road.line[i]}, kReach_m), road.line[i]);
      if (i > 0) {
        pieces_.Add(Around({road.line[i - 1], road.line[i]}, kReach_m),
                    {road.line[i - 1], road.line[i], road.half_width_m});
      }
    }
  }
  for (const Building& building : town.buildings) {
    if (!sight.Contains(building.footprint.front())) continue;
    Box2 box;
    for (const Vec2d& p : building.footprint) box.Extend(p);
    buildings_.Add(box.Grown(kReach_m), &building);
  }
}

bool Clearance::IsFree(const Vec2d& p, double radius) const {
  constexpr double kKerb_m = 0.3;
  constexpr double kToWall_m = 0.4;
  constexpr double kJunction_m = 9;
  for (const Piece& piece : pieces_.At(p)) {
    if (DistanceToSegment(p, piece.from, piece.to) < piece.half_width_m + kKerb_m + radius) return false;
  }
  for (const Vec2d& junction : junctions_.At(p)) {
    if ((p - junction).norm() < kJunction_m + radius) return false;
  }
  for (const Building* building : buildings_.At(p)) {
    if (DistanceToPolygon(building->footprint, p) < kToWall_m + radius) return false;
  }
  return true;
}

}  // namespace mapweld::sim
