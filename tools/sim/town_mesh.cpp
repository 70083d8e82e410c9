// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/town_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "tools/sim/building_mesh.hpp"
#include "tools/sim/cellar_mesh.hpp"
#include "tools/sim/roadside.hpp"

namespace mapweld::sim {
namespace {

Eigen::Vector3d Lift(const Vec2d& p, double z) {
  return {p.x(), p.y(), z};
}

// Small tiles, because a ray is cut with single precision relative to the size of a triangle; tiny ones about the
// trenches of ramps, which are left out.
void AddGround(const Town& town, const Sight& sight, TownMesh& mesh) {
  constexpr double kBelowRoad_m = -0.05;
  constexpr double kTiny_m = 0.5;
  const auto add = [&](const Vec2d& middle, double side_m) {
    Of(mesh, Surface::kGrass).AddFace(Rectangle(middle, Vec2d::UnitX(), side_m / 2, side_m / 2), kBelowRoad_m);
  };
  const std::vector<Ramp> ramps = RampsOf(town);
  for (const Vec2d& corner : sight.Cells()) {
    const Vec2d middle = corner + Vec2d::Constant(Sight::kCell_m / 2);
    std::vector<Ramp> near;
    for (const Ramp& ramp : ramps) {
      if (DistanceToSegment(middle, ramp.line.front(), ramp.line.back()) < Sight::kCell_m) near.push_back(ramp);
    }
    if (near.empty()) {
      add(middle, Sight::kCell_m);
      continue;
    }
    for (double x = kTiny_m / 2; x < Sight::kCell_m; x += kTiny_m) {
      for (double y = kTiny_m / 2; y < Sight::kCell_m; y += kTiny_m) {
        const Vec2d p = corner + Vec2d(x, y);
        const bool open =
            std::any_of(near.begin(), near.end(), [&](const Ramp& ramp) { return InTrench(ramp, *town.cellar, p); });
        if (!open) add(p, kTiny_m);
      }
    }
  }
}

// A disc at a node closes the wedge between two straight pieces.
void AddDisc(const Vec2d& node, double radius_m, Mesh* surface) {
  constexpr int kCorners = 12;
  Polyline disc;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2 * 3.14159265358979 * k / kCorners;
    disc.emplace_back(node + radius_m * Vec2d(std::cos(angle), std::sin(angle)));
  }
  surface->AddFace(disc, 0);
}

// In short pieces, so that they can follow hills. A ramp is straight, and its pieces shorter.
Mesh RoadSurface(const Road& road, const Sight& sight, bool is_ramp) {
  const double piece_m = is_ramp ? 1 : 10;
  Mesh surface;
  for (std::size_t i = 0; i < road.line.size(); ++i) {
    if (!sight.Contains(road.line[i])) continue;
    if (!is_ramp) AddDisc(road.line[i], road.half_width_m, &surface);
    if (i == 0) continue;
    const Vec2d step = road.line[i] - road.line[i - 1];
    if (step.norm() < 1e-6) continue;
    const double pieces = std::ceil(step.norm() / piece_m);
    for (double k = 0; k < pieces; ++k) {
      const Vec2d middle = road.line[i - 1] + (k + 0.5) / pieces * step;
      surface.AddFace(Rectangle(middle, step.normalized(), step.norm() / pieces / 2, road.half_width_m), 0);
    }
  }
  return surface;
}

// Streets and passages below are built at z = 0: down to where they run.
void LowerIntoCellar(const Cellar& cellar, Mesh* mesh) {
  mesh->Raise([&](const Vec2d& p) { return -cellar.Depth(p); });
}

void AddRoads(const Town& town, const Sight& sight, TownMesh& mesh) {
  const std::vector<Ramp> ramps = RampsOf(town);
  for (Road road : town.roads) {
    const auto ramp = std::find_if(ramps.begin(), ramps.end(), [&](const Ramp& r) { return r.line == road.line; });
    const bool is_ramp = ramp != ramps.end();
    if (is_ramp) road.half_width_m = ramp->half_width_m;
    Mesh surface = RoadSurface(road, sight, is_ramp);
    if (town.cellar) LowerIntoCellar(*town.cellar, &surface);
    Of(mesh, Surface::kRoad).Append(surface);
  }
}

void AddBarrier(const Barrier& barrier, TownMesh& mesh) {
  const double half_width = barrier.hedge ? 0.3 : 0.08;
  for (std::size_t i = 1; i < barrier.line.size(); ++i) {
    AddGardenWall(barrier.line[i - 1], barrier.line[i], half_width, barrier.height_m, barrier.hedge, mesh);
  }
}

// Walls with pillars in front of them, and a ceiling.
void AddPassage(const Passage& passage, TownMesh& mesh) {
  constexpr double kPillar_m = 5;
  const double half = passage.half_width_m + 0.6;
  double driven = 0;
  const double length = Length(passage.line);
  for (std::size_t i = 1; i < passage.line.size(); ++i) {
    const Vec2d step = passage.line[i] - passage.line[i - 1];
    const Vec2d along = step.normalized();
    const Vec2d left(-along.y(), along.x());
    const auto at = [&](double s, double aside) -> Vec2d { return passage.line[i - 1] + s * along + aside * left; };
    Of(mesh, Surface::kWall).AddFace(Rectangle(at(step.norm() / 2, 0), along, step.norm() / 2, half), passage.height_m);
    const double from = std::clamp(passage.open_m - driven, 0.0, step.norm());
    const double to = std::clamp(length - passage.open_m - driven, 0.0, step.norm());
    for (const double side : {-1.0, 1.0}) {
      if (to - from < 0.1) continue;
      Of(mesh, Surface::kWall)
          .AddQuad(Lift(at(from, side * half), -0.05), Lift(at(to, side * half), -0.05),
                   Lift(at(to, side * half), passage.height_m), Lift(at(from, side * half), passage.height_m));
      for (double s = from + kPillar_m / 2; s < to; s += kPillar_m) {
        Of(mesh, Surface::kWall)
            .AddWalls(Rectangle(at(s, side * (half - 0.2)), along, 0.2, 0.2), -0.05, passage.height_m);
      }
    }
    driven += step.norm();
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

void Mesh::Append(const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& t : other.triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

TownMesh BuildTownMesh(const Town& town, const Sight& sight, const Sight& close) {
  TownMesh mesh;
  AddGround(town, sight, mesh);
  AddRoads(town, sight, mesh);
  for (const Building& building : town.buildings) {
    const Vec2d& corner = building.footprint.front();
    if (sight.Contains(corner)) AddBuilding(building, close.Contains(corner), mesh);
  }
  TownMesh passages;
  for (const Passage& passage : town.passages) {
    if (sight.Contains(passage.line.front())) AddPassage(passage, passages);
  }
  Mesh& walls = Of(passages, Surface::kWall);
  if (town.cellar) {
    LowerIntoCellar(*town.cellar, &walls);
    AddCellar(town, &mesh);
  }
  Of(mesh, Surface::kWall).Append(walls);
  for (const Barrier& barrier : town.barriers) {
    if (sight.Contains(barrier.line.front())) AddBarrier(barrier, mesh);
  }
  for (const Tree& tree : town.trees) {
    if (sight.Contains(tree.position)) AddTree(tree.position, static_cast<std::uint64_t>(tree.id), mesh);
  }
  AddRoadside(PlotsAlongStreets(town, sight), Clearance(town, sight), mesh);
  return mesh;
}

}  // namespace mapweld::sim
