// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/cellar_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mapweld::sim {
namespace {

constexpr double kUnderStreet_m = 0.05;  // the floor lies that far under it
constexpr double kParapet_m = 0.9;
constexpr double kBesideStreet_m = 0.6;  // from the carriageway to a wall

// In pieces that can follow hills.
void AddWall(const Vec2d& from, const Vec2d& to, double from_low, double to_low, double high, TownMesh* mesh) {
  constexpr double kPiece_m = 10;
  const double pieces = std::ceil((to - from).norm() / kPiece_m);
  for (double k = 0; k < pieces; ++k) {
    const double u = k / pieces;
    const double v = (k + 1) / pieces;
    const Vec2d a = from + u * (to - from);
    const Vec2d b = from + v * (to - from);
    Of(*mesh, Surface::kWall)
        .AddQuad({a.x(), a.y(), from_low + u * (to_low - from_low)}, {b.x(), b.y(), from_low + v * (to_low - from_low)},
                 {b.x(), b.y(), high}, {a.x(), a.y(), high});
  }
}

// Where a line crosses the cellar's edge.
Vec2d AtEdge(const Polyline& line, const Cellar& cellar) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double before = cellar.out.dot(line[i - 1]) - cellar.edge_m;
    const double after = cellar.out.dot(line[i]) - cellar.edge_m;
    if ((before <= 0) != (after <= 0)) return line[i - 1] + before / (before - after) * (line[i] - line[i - 1]);
  }
  return line.front();
}

void AddTrenchWalls(const Ramp& ramp, const Cellar& cellar, TownMesh* mesh) {
  constexpr double kStep_m = 1;
  const Polyline line = Resample(ramp.line, kStep_m);
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec2d along = (line[i] - line[i - 1]).normalized();
    for (const double side : {-1.0, 1.0}) {
      const Vec2d aside = side * ramp.half_width_m * Vec2d(-along.y(), along.x());
      Vec2d a = line[i - 1] + aside;
      Vec2d b = line[i] + aside;
      const double a_out_m = cellar.out.dot(a) - cellar.edge_m;
      const double b_out_m = cellar.out.dot(b) - cellar.edge_m;
      if (a_out_m <= 0 && b_out_m <= 0) continue;  // under the square
      if (a_out_m < 0) a += a_out_m / (a_out_m - b_out_m) * (b - a);
      if (b_out_m < 0) b += b_out_m / (b_out_m - a_out_m) * (a - b);
      if (cellar.Depth(a) < kUnderStreet_m && cellar.Depth(b) < kUnderStreet_m) continue;
      AddWall(a, b, -cellar.Depth(a) - kUnderStreet_m, -cellar.Depth(b) - kUnderStreet_m, kParapet_m, mesh);
    }
  }
}

// The wall on the side of the ramps has a gate for each, with a lintel over it.
void AddEdgeWall(const std::vector<Ramp>& ramps, const Cellar& cellar, TownMesh* mesh) {
  const Vec2d from = cellar.outline[3];
  const Vec2d along = (cellar.outline[2] - from).normalized();
  const double length_m = (cellar.outline[2] - from).norm();
  const double low = -cellar.depth_m - kUnderStreet_m;
  const double ceiling = Cellar::kCeiling_m - cellar.depth_m;
  std::vector<std::pair<double, double>> gates;
  for (const Ramp& ramp : ramps) {
    const double at = along.dot(AtEdge(ramp.line, cellar) - from);
    gates.emplace_back(at - ramp.half_width_m, at + ramp.half_width_m);
  }
  std::sort(gates.begin(), gates.end());
  double walled_m = 0;
  for (const auto& [begin, end] : gates) {
    AddWall(from + walled_m * along, from + begin * along, low, low, ceiling, mesh);
    AddWall(from + begin * along, from + end * along, ceiling, ceiling, kParapet_m, mesh);
    walled_m = end;
  }
  AddWall(from + walled_m * along, from + length_m * along, low, low, ceiling, mesh);
}

}  // namespace

std::vector<Ramp> RampsOf(const Town& town) {
  std::vector<Ramp> ramps;
  if (!town.cellar) return ramps;
  for (const Road& road : town.roads) {
    const auto is_below = [&](const Vec2d& p) { return town.cellar->out.dot(p) <= town.cellar->edge_m; };
    if (is_below(road.line.front()) != is_below(road.line.back())) {
      ramps.push_back({road.line, road.half_width_m + kBesideStreet_m});
    }
  }
  return ramps;
}

bool InTrench(const Ramp& ramp, const Cellar& cellar, const Vec2d& p) {
  if (cellar.out.dot(p) < cellar.edge_m || cellar.Depth(p) < 0.8 * kUnderStreet_m) return false;
  for (std::size_t i = 1; i < ramp.line.size(); ++i) {
    if (DistanceToSegment(p, ramp.line[i - 1], ramp.line[i]) < ramp.half_width_m) return true;
  }
  return false;
}

void AddCellar(const Town& town, TownMesh* mesh) {
  constexpr double kPiece_m = 10;
  const Cellar& cellar = *town.cellar;
  const Polyline& corner = cellar.outline;
  const Vec2d along = corner[1] - corner[0];
  const Vec2d across = corner[3] - corner[0];
  const int columns = static_cast<int>(std::ceil(along.norm() / kPiece_m));
  const int rows = static_cast<int>(std::ceil(across.norm() / kPiece_m));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vec2d middle = corner[0] + (column + 0.5) / columns * along + (row + 0.5) / rows * across;
      const Polyline piece =
          Rectangle(middle, along.normalized(), along.norm() / columns / 2, across.norm() / rows / 2);
      Of(*mesh, Surface::kRoad).AddFace(piece, -cellar.depth_m - kUnderStreet_m);
      Of(*mesh, Surface::kWall).AddFace(piece, Cellar::kCeiling_m - cellar.depth_m);
    }
  }
  const double low = -cellar.depth_m - kUnderStreet_m;
  for (const std::size_t i : {3U, 0U, 1U}) {
    const Vec2d& from = corner[i];
    const Vec2d& to = corner[(i + 1) % 4];
    AddWall(from, to, low, low, Cellar::kCeiling_m - cellar.depth_m, mesh);
  }
  const std::vector<Ramp> ramps = RampsOf(town);
  AddEdgeWall(ramps, cellar, mesh);
  for (const Ramp& ramp : ramps) AddTrenchWalls(ramp, cellar, mesh);
}

}  // namespace mapweld::sim
