// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/town_mesh.hpp"

#include <cmath>

#include "tools/sim/roadside.hpp"

namespace mapweld::sim {
namespace {

Eigen::Vector3d Lift(const Vec2d& p, double z) {
  return {p.x(), p.y(), z};
}

// Small tiles, because a ray is cut with single precision relative to the size of a triangle.
void AddGround(const Box2& area, TownMesh& mesh) {
  constexpr double kTile_m = 50;
  constexpr double kBelowRoad_m = -0.05;
  for (double x = area.low.x(); x < area.high.x(); x += kTile_m) {
    for (double y = area.low.y(); y < area.high.y(); y += kTile_m) {
      const Polyline tile{{x, y}, {x + kTile_m, y}, {x + kTile_m, y + kTile_m}, {x, y + kTile_m}};
      Of(mesh, Surface::kGrass).AddFace(tile, kBelowRoad_m);
    }
  }
}

void AddRoad(const Road& road, const Box2& area, TownMesh& mesh) {
  constexpr int kDiscCorners = 12;
  Mesh& surface = Of(mesh, Surface::kRoad);
  for (std::size_t i = 0; i < road.line.size(); ++i) {
    if (!area.Contains(road.line[i])) continue;
    // A disc at every node closes the wedge between two straight pieces.
    Polyline disc;
    for (int k = 0; k < kDiscCorners; ++k) {
      const double angle = 2 * 3.14159265358979 * k / kDiscCorners;
      disc.emplace_back(road.line[i] + road.half_width_m * Vec2d(std::cos(angle), std::sin(angle)));
    }
    surface.AddFace(disc, 0);
    if (i == 0) continue;
    const Vec2d step = road.line[i] - road.line[i - 1];
    if (step.norm() < 1e-6) continue;
    surface.AddFace(
        Rectangle((road.line[i] + road.line[i - 1]) / 2, step.normalized(), step.norm() / 2, road.half_width_m), 0);
  }
}

void AddBuilding(const Building& building, TownMesh& mesh) {
  Of(mesh, Surface::kWall).AddWalls(building.footprint, -0.05, building.height_m);
  Of(mesh, Surface::kRoof).AddFace(building.footprint, building.height_m);
}

void AddBarrier(const Barrier& barrier, TownMesh& mesh) {
  const double half_width = barrier.hedge ? 0.3 : 0.08;
  for (std::size_t i = 1; i < barrier.line.size(); ++i) {
    AddGardenWall(barrier.line[i - 1], barrier.line[i], half_width, barrier.height_m, barrier.hedge, mesh);
  }
}

}  // namespace

void Mesh::AddQuad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   const Eigen::Vector3d& d) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  for (const auto* p : {&a, &b, &c, &d}) vertices.emplace_back(p->cast<float>());
  triangles.push_back({first, first + 1, first + 2});
  triangles.push_back({first, first + 2, first + 3});
}

void Mesh::AddWalls(const Polyline& base, double z_low, double z_high) {
  for (std::size_t i = 0; i < base.size(); ++i) {
    const Vec2d& a = base[i];
    const Vec2d& b = base[(i + 1) % base.size()];
    AddQuad(Lift(a, z_low), Lift(b, z_low), Lift(b, z_high), Lift(a, z_high));
  }
}

void Mesh::AddFace(const Polyline& base, double z) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  for (const Vec2d& p : base) vertices.emplace_back(Lift(p, z).cast<float>());
  for (const Triangle& t : Triangulate(base)) triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

Polyline Rectangle(const Vec2d& centre, const Vec2d& along, double half_length, double half_width) {
  const Vec2d l = half_length * along;
  const Vec2d w = half_width * Vec2d(-along.y(), along.x());
  return {centre - l - w, centre + l - w, centre + l + w, centre - l + w};
}

TownMesh BuildTownMesh(const Town& town, const Box2& area) {
  TownMesh mesh;
  AddGround(area, mesh);
  for (const Road& road : town.roads) AddRoad(road, area, mesh);
  for (const Building& building : town.buildings) {
    if (area.Contains(building.footprint.front())) AddBuilding(building, mesh);
  }
  for (const Barrier& barrier : town.barriers) {
    if (area.Contains(barrier.line.front())) AddBarrier(barrier, mesh);
  }
  for (const Tree& tree : town.trees) {
    if (area.Contains(tree.position)) AddTree(tree.position, static_cast<std::uint64_t>(tree.id), mesh);
  }
  AddRoadside(town, area, mesh);
  return mesh;
}

}  // namespace mapweld::sim
