// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/house_clearance.hpp"

#include <algorithm>

namespace mapweld::sim {
namespace {

constexpr double kKerb_m = 0.6;

Vec2d ClosestOnSegment(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
  const Vec2d d = b - a;
  return a + d * std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-12), 0.0, 1.0);
}

bool Crosses(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
  const bool c_and_d_apart = (Cross(b - a, c - a) > 0) != (Cross(b - a, d - a) > 0);
  const bool a_and_b_apart = (Cross(d - c, a - c) > 0) != (Cross(d - c, b - c) > 0);
  return c_and_d_apart && a_and_b_apart;
}

// The shortest way from the segment to the polygon; zero when they meet.
Vec2d Gap(const Vec2d& a, const Vec2d& b, const Polyline& polygon) {
  if (Inside(polygon, a)) return Vec2d::Zero();
  Vec2d best = Vec2d::Constant(1e9);
  const auto offer = [&best](const Vec2d& gap) {
    if (gap.squaredNorm() < best.squaredNorm()) best = gap;
  };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d& p = polygon[i];
    const Vec2d& q = polygon[(i + 1) % polygon.size()];
    if (Crosses(a, b, p, q)) return Vec2d::Zero();
    offer(p - ClosestOnSegment(p, a, b));
    offer(ClosestOnSegment(a, p, q) - a);
    offer(ClosestOnSegment(b, p, q) - b);
  }
  return best;
}

}  // namespace

void MoveHousesOffStreets(Town& town) {
  for (Building& building : town.buildings) {
    Polyline& house = building.footprint;
    double reach = 0;
    for (const Vec2d& p : house) reach = std::max(reach, (p - house.front()).norm());
    for (const Road& road : town.roads) {
      if (!road.street) continue;
      const double wanted = road.half_width_m + kKerb_m;
      for (std::size_t i = 1; i < road.line.size(); ++i) {
        if (DistanceToSegment(house.front(), road.line[i - 1], road.line[i]) > reach + wanted) continue;
        const Vec2d gap = Gap(road.line[i - 1], road.line[i], house);
        const double distance = gap.norm();
        if (distance < 1e-6 || distance >= wanted) continue;
        for (Vec2d& p : house) p += gap * ((wanted - distance) / distance);
      }
    }
  }
}

}  // namespace mapweld::sim
