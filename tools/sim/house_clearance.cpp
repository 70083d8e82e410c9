// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/house_clearance.hpp"

#include <algorithm>

#include "tools/sim/plane_index.hpp"

namespace mapweld::sim {
namespace {

constexpr double kKerb_m = 0.6;
constexpr double kLargestHouse_m = 120;  // what reaches farther from its first corner is not looked at there

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

struct Piece {
  Vec2d from;
  Vec2d to;
  double half_width_m;
};

PlaneIndex<Piece> PiecesOfStreets(const Town& town) {
  PlaneIndex<Piece> pieces;
  for (const Road& road : town.roads) {
    if (!road.street) continue;
    for (std::size_t i = 1; i < road.line.size(); ++i) {
      Box2 box;
      box.Extend(road.line[i - 1]);
      box.Extend(road.line[i]);
      pieces.Add(box.Grown(kLargestHouse_m), {road.line[i - 1], road.line[i], road.half_width_m});
    }
  }
  return pieces;
}

}  // namespace

void MoveHousesOffStreets(Town& town) {
  const PlaneIndex<Piece> pieces = PiecesOfStreets(town);
  for (Building& building : town.buildings) {
    Polyline& house = building.footprint;
    double reach = 0;
    for (const Vec2d& p : house) reach = std::max(reach, (p - house.front()).norm());
    for (const Piece& piece : pieces.At(house.front())) {
      const double wanted = piece.half_width_m + kKerb_m;
      if (DistanceToSegment(house.front(), piece.from, piece.to) > reach + wanted) continue;
      const Vec2d gap = Gap(piece.from, piece.to, house);
      const double distance = gap.norm();
      if (distance < 1e-6 || distance >= wanted) continue;
      for (Vec2d& p : house) p += gap * ((wanted - distance) / distance);
    }
  }
}

void RemoveWhatBlocksStreets(Town* town) {
  const PlaneIndex<Piece> pieces = PiecesOfStreets(*town);
  const auto blocked = [&](const Vec2d& p, double margin) {
    const auto near = pieces.At(p);
    return std::any_of(near.begin(), near.end(), [&](const Piece& piece) {
      return DistanceToSegment(p, piece.from, piece.to) < piece.half_width_m + margin;
    });
  };
  std::erase_if(town->buildings, [&](const Building& building) {
    const auto near = pieces.At(building.footprint.front());
    return std::any_of(near.begin(), near.end(), [&](const Piece& piece) {
      return Gap(piece.from, piece.to, building.footprint).norm() < piece.half_width_m + 0.3;
    });
  });
  std::erase_if(town->barriers, [&](const Barrier& barrier) {
    return std::any_of(barrier.line.begin(), barrier.line.end(), [&](const Vec2d& p) { return blocked(p, 0.6); });
  });
  std::erase_if(town->trees, [&](const Tree& tree) { return blocked(tree.position, 2.5); });
}

}  // namespace mapweld::sim
