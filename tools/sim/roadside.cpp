// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/roadside.hpp"

#include <cmath>
#include <numbers>

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

// Kerb and footway, where the plot is clear of junctions.
void AddFootway(const Plot& plot, const Clearance& clearance, TownMesh& mesh) {
  constexpr double kKerb_m = 0.1;
  constexpr double kWidth_m = 1.5;
  constexpr double kOnTheKerb = -0.25;  // may stand this close to the carriageway
  const Vec2d a = plot.At(-kPlot_m / 2, 0.12);
  const Vec2d b = plot.At(kPlot_m / 2, 0.12);
  const Vec2d c = plot.At(kPlot_m / 2, kWidth_m);
  const Vec2d d = plot.At(-kPlot_m / 2, kWidth_m);
  for (const Vec2d& p : {a, b, c, d, Vec2d((a + b) / 2)}) {
    if (!clearance.IsFree(p, kOnTheKerb)) return;
  }
  const auto at = [](const Vec2d& p, double z) { return Vec3d(p.x(), p.y(), z); };
  Mesh& footway = Of(mesh, Surface::kFootway);
  footway.AddQuad(at(a, kKerb_m), at(b, kKerb_m), at(c, kKerb_m), at(d, kKerb_m));
  footway.AddQuad(at(a, -0.05), at(b, -0.05), at(b, kKerb_m), at(a, kKerb_m));
}

// A plate on a post, looking along the street.
void AddSign(const Vec2d& foot, const Vec2d& along, std::uint64_t seed, TownMesh& mesh) {
  const double height = Uniform(Hash(seed, 1), 2.2, 2.6);
  const double half = Uniform(Hash(seed, 2), 0.25, 0.45);
  Of(mesh, Surface::kPole).AddWalls(Disc(foot, 0.035, 6), -0.05, height);
  Of(mesh, Surface::kSign).AddWalls(Rectangle(foot, along, 0.02, half), height - 2 * half, height);
}

void FillPlot(const Plot& plot, const Clearance& clearance, TownMesh& mesh) {
  AddFootway(plot, clearance, mesh);
  const double second = Uniform(Hash(plot.seed, 3));
  if (second < 0.5) {
    const double half_length = Uniform(Hash(plot.seed, 4), 1.5, 3.5);
    const bool hedge = second < 0.22;
    const double height = hedge ? Uniform(Hash(plot.seed, 5), 1.0, 1.9) : Uniform(Hash(plot.seed, 5), 0.5, 1.4);
    const double outward = 2.7 + Uniform(Hash(plot.seed, 6), 0, 0.6);
    const Vec2d from = plot.At(-half_length, outward);
    const Vec2d to = plot.At(half_length, outward);
    if (clearance.IsFree(from, 0.4) && clearance.IsFree((from + to) / 2, 0.4) && clearance.IsFree(to, 0.4)) {
      AddGardenWall(from, to, hedge ? 0.3 : 0.12, height, hedge, mesh);
    }
  } else if (second < 0.75) {
    const Vec2d foot = plot.At(Uniform(Hash(plot.seed, 7), -2, 2), Uniform(Hash(plot.seed, 8), 3.4, 8.0));
    if (clearance.IsFree(foot, 2.6)) AddTree(foot, plot.seed, mesh);
  } else if (second < 0.80) {
    const Vec2d foot = plot.At(Uniform(Hash(plot.seed, 9), -3, 3), 1.0);
    if (clearance.IsFree(foot, 0.5)) AddSign(foot, plot.along, plot.seed, mesh);
  }
}

}  // namespace

void AddTree(const Vec2d& foot, std::uint64_t seed, TownMesh& mesh) {
  const bool conifer = Uniform(Hash(seed, 10)) < 0.2;
  const double size = Uniform(Hash(seed, 13));  // young to old
  const double trunk_height = conifer ? 0.8 : 1.8 + size;
  const double trunk_radius = 0.08 + 0.16 * size;
  const double radius = conifer ? 0.8 + 1.4 * size : 1.0 + 2.0 * size;
  const double half_height = radius * (conifer ? 2.4 : Uniform(Hash(seed, 14), 0.8, 1.4));
  Of(mesh, Surface::kTrunk).AddWalls(Disc(foot, trunk_radius, 7), -0.05, trunk_height + 0.8 * half_height);
  const Vec3d centre(foot.x(), foot.y(), trunk_height + half_height);
  constexpr std::uint64_t kPatches = 90;
  for (std::uint64_t i = 0; i < kPatches; ++i) {
    const auto random = [&](std::uint64_t what, double low, double high) {
      return Uniform(Hash(seed, 100 + i, what), low, high);
    };
    // Most patches near the outside; of a conifer, most of them low.
    const double up = conifer ? 1 - 2 * std::sqrt(random(1, 0, 1)) : random(1, -1, 1);
    const double turn = random(2, 0, 2 * std::numbers::pi);
    const double level = conifer ? (1 - up) / 2 : std::sqrt(1 - up * up);
    const double out = std::sqrt(random(3, 0.15, 1));
    const Vec3d middle = centre + Vec3d(out * radius * level * std::cos(turn), out * radius * level * std::sin(turn),
                                        (conifer ? 1 : out) * half_height * up);
    const double leaf = 0.2 + 0.14 * radius;
    const Vec3d u = leaf * Vec3d(random(4, -1, 1), random(5, -1, 1), random(6, -1, 1));
    const Vec3d v = leaf * Vec3d(random(7, -1, 1), random(8, -1, 1), random(9, -1, 1));
    Of(mesh, Surface::kFoliage).AddQuad(middle - u - v, middle + u - v, middle + u + v, middle - u + v);
  }
}

void AddGardenWall(const Vec2d& from, const Vec2d& to, double half_width, double height, bool hedge, TownMesh& mesh) {
  const double length = (to - from).norm();
  if (length < 0.05) return;
  const Polyline base = Rectangle((from + to) / 2, (to - from) / length, length / 2, half_width);
  Mesh& wall = Of(mesh, hedge ? Surface::kHedge : Surface::kGardenWall);
  wall.AddWalls(base, -0.05, height);
  wall.AddFace(base, height);
}

void AddRoadside(const std::vector<Plot>& plots, const Clearance& clearance, TownMesh& mesh) {
  constexpr int kPlotsPerLamp = 4;
  for (const Plot& plot : plots) {
    FillPlot(plot, clearance, mesh);
    const bool on_the_right = Cross(plot.along, plot.outward) < 0;
    const Vec2d lamp = plot.At(kPlot_m / 2, 0.6);
    if (on_the_right && plot.number % kPlotsPerLamp == 0 && clearance.IsFree(lamp, 0.1)) AddLamp(lamp, mesh);
  }
}

}  // namespace mapweld::sim
