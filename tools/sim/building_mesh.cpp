// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/building_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {
namespace {

using Eigen::Vector3d;

constexpr double kFoot_m = -0.3;  // walls begin under the ground, which may slope

Vector3d Lift(const Vec2d& p, double z) {
  return {p.x(), p.y(), z};
}

// Coordinates on a facade: x along it, outward from it, z up.
class Facade {
 public:
  Facade(const Vec2d& a, const Vec2d& b, TownMesh& mesh)
      : a_(a), along_((b - a).normalized()), out_(along_.y(), -along_.x()), mesh_(mesh) {}

  void Wall(double x0, double x1, double z0, double z1, double out = 0, Surface kind = Surface::kWall) {
    if (x1 - x0 < 1e-3 || z1 - z0 < 1e-3) return;
    Of(mesh_, kind).AddQuad(At(x0, out, z0), At(x1, out, z0), At(x1, out, z1), At(x0, out, z1));
  }
  // A hole in the wall with its four sides, closed at the depth.
  void Opening(double x0, double x1, double z0, double z1, double depth, Surface kind) {
    Mesh& wall = Of(mesh_, Surface::kWall);
    Wall(x0, x1, z0, z1, -depth, kind);
    wall.AddQuad(At(x0, 0, z0), At(x0, -depth, z0), At(x0, -depth, z1), At(x0, 0, z1));
    wall.AddQuad(At(x1, -depth, z0), At(x1, 0, z0), At(x1, 0, z1), At(x1, -depth, z1));
    wall.AddQuad(At(x0, 0, z0), At(x1, 0, z0), At(x1, -depth, z0), At(x0, -depth, z0));
    wall.AddQuad(At(x0, -depth, z1), At(x1, -depth, z1), At(x1, 0, z1), At(x0, 0, z1));
  }
  void Balcony(double x0, double x1, double floor) {
    constexpr double kDepth_m = 1.1;
    const auto plane = [this](double x, double out) -> Vec2d { return a_ + x * along_ + out * out_; };
    // Counter-clockwise seen from above; the side at the house closes it.
    const Polyline slab{plane(x0, 0), plane(x0, kDepth_m), plane(x1, kDepth_m), plane(x1, 0)};
    Of(mesh_, Surface::kWall).AddWalls(slab, floor - 0.15, floor + 0.95);
    Of(mesh_, Surface::kWall).AddFace(slab, floor);
  }

 private:
  [[nodiscard]] Vector3d At(double x, double out, double z) const { return Lift(a_ + x * along_ + out * out_, z); }
  Vec2d a_;
  Vec2d along_;
  Vec2d out_;
  TownMesh& mesh_;
};

// A ridge over a four-cornered house. Gable ends are walls; a hip's are roof.
void AddRidgeRoof(Polyline base, double eaves, double ridge, bool hip, TownMesh& mesh) {
  if ((base[1] - base[0]).norm() < (base[2] - base[1]).norm()) std::rotate(base.begin(), base.begin() + 1, base.end());
  const Vec2d end_a = (base[3] + base[0]) / 2;
  const Vec2d end_b = (base[1] + base[2]) / 2;
  const double half_width = (base[2] - base[1]).norm() / 2;
  const double inset = hip ? std::min(0.8 * half_width, 0.45 * (end_b - end_a).norm()) : 0;
  const Vec2d along = (end_b - end_a).normalized();
  const Vector3d ridge_a = Lift(end_a + inset * along, ridge);
  const Vector3d ridge_b = Lift(end_b - inset * along, ridge);
  Mesh& roof = Of(mesh, Surface::kRoof);
  roof.AddQuad(Lift(base[0], eaves), Lift(base[1], eaves), ridge_b, ridge_a);
  roof.AddQuad(Lift(base[2], eaves), Lift(base[3], eaves), ridge_a, ridge_b);
  Mesh& ends = Of(mesh, hip ? Surface::kRoof : Surface::kWall);
  // Split in the middle, so that every face is two triangles.
  ends.AddQuad(Lift(base[1], eaves), Lift(end_b, eaves), Lift(base[2], eaves), ridge_b);
  ends.AddQuad(Lift(base[3], eaves), Lift(end_a, eaves), Lift(base[0], eaves), ridge_a);
}

RoofShape ChooseRoof(const Building& building) {
  if (building.footprint.size() != 4) return RoofShape::kFlat;
  if (building.roof != RoofShape::kAny) return building.roof;
  const double area = SignedArea(building.footprint);
  const double kind = Uniform(Hash(static_cast<std::uint64_t>(building.id), 0x400F));
  if (area < 35) return kind < 0.7 ? RoofShape::kFlat : RoofShape::kGable;
  if (area > 500) return kind < 0.8 ? RoofShape::kFlat : RoofShape::kGable;
  return kind < 0.6 ? RoofShape::kGable : kind < 0.85 ? RoofShape::kHip : RoofShape::kFlat;
}

}  // namespace

void AddFacade(const Vec2d& a, const Vec2d& b, double height, std::uint64_t seed, TownMesh& mesh) {
  const double length = (b - a).norm();
  if (length < 1e-3) return;
  Facade facade(a, b, mesh);
  const double pitch = Uniform(Hash(seed, 1), 2.2, 3.8);
  const double storey = Uniform(Hash(seed, 2), 2.7, 3.1);
  const double width = pitch * Uniform(Hash(seed, 3), 0.32, 0.5);
  const double depth = Uniform(Hash(seed, 4), 0.10, 0.28);
  const auto columns = static_cast<int>((length - 0.6) / pitch);
  const auto storeys = static_cast<int>(height / storey + 0.2);
  if (columns < 1 || storeys < 1 || height < 2.5) return facade.Wall(0, length, kFoot_m, height);
  const auto of_wall = static_cast<std::uint64_t>(std::llround(length * 1000));
  const int door = Uniform(Hash(seed, 5, of_wall)) < 0.5
                       ? static_cast<int>(Hash(seed, 6, of_wall) % static_cast<std::uint64_t>(columns))
                       : -1;
  const bool balconies = storeys > 1 && Uniform(Hash(seed, 7, of_wall)) < 0.18;
  const double margin = (length - columns * pitch) / 2;
  double done = 0;
  for (int column = 0; column < columns; ++column) {
    const double middle = margin + (column + 0.5) * pitch;
    const double x0 = middle - width / 2;
    const double x1 = middle + width / 2;
    facade.Wall(done, x0, kFoot_m, height);
    double z = kFoot_m;
    for (int floor = 0; floor < storeys; ++floor) {
      const double level = floor * storey;
      const bool is_door = floor == 0 && column == door;
      const double low = is_door ? 0.05 : level + 0.95;
      const double high = std::min(level + 2.25, height - 0.1);
      if (high - low < 0.4) break;
      facade.Wall(x0, x1, z, low);
      facade.Opening(x0, x1, low, high, is_door ? depth + 0.15 : depth, is_door ? Surface::kWall : Surface::kGlass);
      if (balconies && floor > 0 && column % 2 == 0) facade.Balcony(x0 - 0.5, x1 + 0.5, level + 0.1);
      z = high;
    }
    facade.Wall(x0, x1, z, height);
    done = x1;
  }
  facade.Wall(done, length, kFoot_m, height);
}

void AddBuilding(const Building& building, bool detailed, TownMesh& mesh) {
  const Polyline& base = building.footprint;
  const auto seed = static_cast<std::uint64_t>(building.id);
  const RoofShape roof = ChooseRoof(building);
  double eaves = building.height_m;
  if (roof != RoofShape::kFlat) {
    const double width = std::min((base[1] - base[0]).norm(), (base[2] - base[1]).norm());
    eaves -= std::min(width * Uniform(Hash(seed, 0xEA5E), 0.25, 0.5), 0.45 * building.height_m);
  }
  if (detailed) {
    for (std::size_t i = 0; i < base.size(); ++i) AddFacade(base[i], base[(i + 1) % base.size()], eaves, seed, mesh);
  } else {
    Of(mesh, Surface::kWall).AddWalls(base, kFoot_m, eaves);
  }
  if (roof == RoofShape::kFlat) {
    Of(mesh, Surface::kRoof).AddFace(base, eaves);
  } else {
    AddRidgeRoof(base, eaves, building.height_m, roof == RoofShape::kHip, mesh);
  }
}

}  // namespace mapweld::sim
