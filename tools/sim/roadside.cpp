// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/roadside.hpp"

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <span>
#include <unordered_map>
#include <vector>

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {
namespace {

using Vec3d = Eigen::Vector3d;

Polyline Disc(const Vec2d& centre, double radius, int corners) {
  Polyline out;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    out.emplace_back(centre + radius * Vec2d(std::cos(angle), std::sin(angle)));
  }
  return out;
}

void AddLamp(const Vec2d& foot, TownMesh& mesh) {
  Of(mesh, Surface::kPole).AddWalls(Disc(foot, 0.09, 8), -0.05, 6.5);
}

void AddCar(const Vec2d& centre, const Vec2d& along, std::uint64_t seed, TownMesh& mesh) {
  Mesh& car = Of(mesh, Surface::kCar);
  const double half_length = Uniform(Hash(seed, 1), 1.9, 2.4);
  const double height = Uniform(Hash(seed, 2), 1.4, 1.8);
  const Polyline body = Rectangle(centre, along, half_length, 0.88);
  const Polyline cabin = Rectangle(centre - 0.2 * along, along, half_length * 0.6, 0.8);
  car.AddWalls(body, 0.2, 0.85);
  car.AddFace(body, 0.85);
  car.AddWalls(cabin, 0.85, height);
  car.AddFace(cabin, height);
}

// Things by the squares of the plane that they reach into.
template <class Thing>
class PlaneIndex {
 public:
  void Add(const Box2& reach, const Thing& thing) {
    for (int x = Cell(reach.low.x()); x <= Cell(reach.high.x()); ++x) {
      for (int y = Cell(reach.low.y()); y <= Cell(reach.high.y()); ++y) cells_[Key(x, y)].push_back(thing);
    }
  }
  [[nodiscard]] std::span<const Thing> At(const Vec2d& p) const {
    const auto found = cells_.find(Key(Cell(p.x()), Cell(p.y())));
    return found == cells_.end() ? std::span<const Thing>{} : std::span<const Thing>{found->second};
  }

 private:
  static int Cell(double x) { return static_cast<int>(std::floor(x / 40)); }
  static std::int64_t Key(int x, int y) { return static_cast<std::int64_t>(x) * 1'000'003 + y; }
  std::unordered_map<std::int64_t, std::vector<Thing>> cells_;
};

// Keeps pieces off every carriageway, out of every house and away from junctions.
class Clearance {
 public:
  Clearance(const Town& town, const Box2& area) {
    std::unordered_map<std::int64_t, int> ends;
    const auto around = [](std::initializer_list<Vec2d> points, double margin) {
      Box2 box;
      for (const Vec2d& p : points) box.Extend(p);
      return box.Grown(margin);
    };
    for (const Road& road : town.roads) {
      for (std::size_t i = 0; i < road.nodes.size(); ++i) {
        int& n = ends[road.nodes[i]];
        const int before = n;
        n += (i > 0 ? 1 : 0) + (i + 1 < road.nodes.size() ? 1 : 0);
        if (before < 3 && n >= 3 && area.Contains(road.line[i]))
          junctions_.Add(around({road.line[i]}, kReach_m), road.line[i]);
        if (i == 0) continue;
        const double reach = (road.line[i] - road.line[i - 1]).norm();
        if (area.Grown(reach).Contains(road.line[i])) {
          pieces_.Add(around({road.line[i - 1], road.line[i]}, kReach_m),
                      {road.line[i - 1], road.line[i], road.half_width_m});
        }
      }
    }
    for (const Building& building : town.buildings) {
      if (!area.Contains(building.footprint.front())) continue;
      Box2 box;
      for (const Vec2d& p : building.footprint) box.Extend(p);
      buildings_.Add(box.Grown(kReach_m), &building);
    }
  }
  // True when a disc of this radius stands free.
  [[nodiscard]] bool IsFree(const Vec2d& p, double radius) const {
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

 private:
  struct Piece {
    Vec2d from;
    Vec2d to;
    double half_width_m;
  };
  static constexpr double kReach_m = 16;  // no clearance asked for is wider, half a carriageway included
  PlaneIndex<Piece> pieces_;
  PlaneIndex<Vec2d> junctions_;
  PlaneIndex<const Building*> buildings_;
};

// One plot of the roadside: its middle, the direction of the street, the direction away from the street.
struct Plot {
  Vec2d on_street;
  Vec2d along;
  Vec2d outward;
  double half_width_m;
  std::uint64_t seed;
};

void FillPlot(const Plot& plot, const Clearance& clearance, TownMesh& mesh) {
  const auto at = [&](double along, double outward) -> Vec2d {
    return plot.on_street + along * plot.along + (plot.half_width_m + outward) * plot.outward;
  };
  const double kind = Uniform(Hash(plot.seed, 1));
  if (kind < 0.22) {
    const Vec2d centre = at(Uniform(Hash(plot.seed, 2), -0.5, 0.5), 1.4);
    const bool free = clearance.IsFree(centre - 1.6 * plot.along, 0.9) && clearance.IsFree(centre, 0.9) &&
                      clearance.IsFree(centre + 1.6 * plot.along, 0.9);
    if (free) AddCar(centre, plot.along, plot.seed, mesh);
  }
  const double second = Uniform(Hash(plot.seed, 3));
  if (second < 0.5) {
    const double half_length = Uniform(Hash(plot.seed, 4), 1.5, 3.5);
    const bool hedge = second < 0.22;
    const double height = hedge ? Uniform(Hash(plot.seed, 5), 1.0, 1.9) : Uniform(Hash(plot.seed, 5), 0.5, 1.4);
    const double outward = 2.7 + Uniform(Hash(plot.seed, 6), 0, 0.6);
    const Vec2d from = at(-half_length, outward);
    const Vec2d to = at(half_length, outward);
    if (clearance.IsFree(from, 0.4) && clearance.IsFree((from + to) / 2, 0.4) && clearance.IsFree(to, 0.4)) {
      AddGardenWall(from, to, hedge ? 0.3 : 0.12, height, hedge, mesh);
    }
  } else if (second < 0.75) {
    const Vec2d foot = at(Uniform(Hash(plot.seed, 7), -2, 2), Uniform(Hash(plot.seed, 8), 3.4, 8.0));
    if (clearance.IsFree(foot, 1.2)) AddTree(foot, plot.seed, mesh);
  }
}

}  // namespace

void AddTree(const Vec2d& foot, std::uint64_t seed, TownMesh& mesh) {
  const double trunk_height = Uniform(Hash(seed, 11), 1.8, 2.8);
  const double trunk_radius = Uniform(Hash(seed, 12), 0.09, 0.22);
  const double radius = Uniform(Hash(seed, 13), 1.0, 2.3);
  const double half_height = radius * Uniform(Hash(seed, 14), 0.8, 1.4);
  Of(mesh, Surface::kTrunk).AddWalls(Disc(foot, trunk_radius, 7), -0.05, trunk_height + 0.5);
  const Vec3d centre(foot.x(), foot.y(), trunk_height + half_height);
  constexpr std::uint64_t kPatches = 70;
  for (std::uint64_t i = 0; i < kPatches; ++i) {
    const auto random = [&](std::uint64_t what, double low, double high) {
      return Uniform(Hash(seed, 100 + i, what), low, high);
    };
    // Evenly over directions, most patches near the outside.
    const double up = random(1, -1, 1);
    const double turn = random(2, 0, 2 * std::numbers::pi);
    const double level = std::sqrt(1 - up * up);
    const double out = std::sqrt(random(3, 0.15, 1));
    const Vec3d middle =
        centre + out * Vec3d(radius * level * std::cos(turn), radius * level * std::sin(turn), half_height * up);
    const Vec3d u = 0.38 * Vec3d(random(4, -1, 1), random(5, -1, 1), random(6, -1, 1));
    const Vec3d v = 0.38 * Vec3d(random(7, -1, 1), random(8, -1, 1), random(9, -1, 1));
    Of(mesh, Surface::kFoliage).AddQuad(middle - u - v, middle + u - v, middle + u + v, middle - u + v);
  }
}

void AddGardenWall(const Vec2d& from, const Vec2d& to, double half_width, double height, bool hedge, TownMesh& mesh) {
  const double length = (to - from).norm();
  if (length < 0.05) return;
  const Polyline base = Rectangle((from + to) / 2, (to - from) / length, length / 2, half_width);
  Mesh& wall = Of(mesh, hedge ? Surface::kFoliage : Surface::kGardenWall);
  wall.AddWalls(base, -0.05, height);
  wall.AddFace(base, height);
}

void AddRoadside(const Town& town, const Box2& area, TownMesh& mesh) {
  constexpr double kPlot_m = 7.5;
  constexpr int kPlotsPerLamp = 4;
  const Clearance clearance(town, area);
  for (const Road& road : town.roads) {
    if (!road.street || Length(road.line) < kPlot_m) continue;
    const Polyline line = Resample(road.line, kPlot_m);
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Vec2d middle = (line[i] + line[i - 1]) / 2;
      if (!area.Contains(middle)) continue;
      const Vec2d along = (line[i] - line[i - 1]).normalized();
      for (const double side : {1.0, -1.0}) {
        const Vec2d outward = side * Vec2d(-along.y(), along.x());
        const std::uint64_t seed = Hash(static_cast<std::uint64_t>(road.id), i, side > 0 ? 1 : 2);
        FillPlot({middle, along, outward, road.half_width_m, seed}, clearance, mesh);
      }
      const Vec2d lamp = line[i] + (road.half_width_m + 0.6) * Vec2d(along.y(), -along.x());
      if (i % kPlotsPerLamp == 0 && clearance.IsFree(lamp, 0.1)) AddLamp(lamp, mesh);
    }
  }
}

}  // namespace mapweld::sim
