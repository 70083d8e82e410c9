// SPDX-License-Identifier: Apache-2.0
// Plane polygons and polylines of the town, metres.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace mapweld::sim {

using Vec2d = Eigen::Vector2d;
using Polyline = std::vector<Vec2d>;

struct Box2 {
  Vec2d low = Vec2d::Constant(1e300);
  Vec2d high = Vec2d::Constant(-1e300);
  void Extend(const Vec2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  [[nodiscard]] Box2 Grown(double margin) const {
    return {low - Vec2d::Constant(margin), high + Vec2d::Constant(margin)};
  }
  [[nodiscard]] bool Contains(const Vec2d& p) const {
    return p.x() >= low.x() && p.y() >= low.y() && p.x() <= high.x() && p.y() <= high.y();
  }
};

inline double Cross(const Vec2d& a, const Vec2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}
// Positive for counter-clockwise order.
double SignedArea(const Polyline& polygon);
double Length(const Polyline& line);
double DistanceToSegment(const Vec2d& p, const Vec2d& a, const Vec2d& b);
bool Inside(const Polyline& polygon, const Vec2d& p);
// 0 inside, else the distance to the nearest edge.
double DistanceToPolygon(const Polyline& polygon, const Vec2d& p);
// Ear clipping of a simple counter-clockwise polygon; O(n^2). A polygon that crosses itself gives fewer triangles,
// never an endless loop.
std::vector<std::array<std::uint32_t, 3>> Triangulate(const Polyline& polygon);
// Points `spacing` apart (the last step takes what is left over by shrinking all steps a little).
Polyline Resample(const Polyline& line, double spacing);

}  // namespace mapweld::sim
