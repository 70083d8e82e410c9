// SPDX-License-Identifier: Apache-2.0
// The town as triangles, one mesh per kind of surface. World frame, metres; roads lie at z = 0.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "tools/sim/sight.hpp"
#include "tools/sim/surface.hpp"
#include "tools/sim/town.hpp"

namespace mapweld::sim {

struct Mesh {
  using Triangle = std::array<std::uint32_t, 3>;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Triangle> triangles;

  // A flat four-cornered face is always two triangles in a row.
  void AddQuad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& d);
  // Walls around `base` from z_low to z_high.
  void AddWalls(const Polyline& base, double z_low, double z_high);
  // All of another mesh.
  void Append(const Mesh& other);
  // A horizontal face over a counter-clockwise polygon.
  void AddFace(const Polyline& base, double z);
  // Every vertex at (x, y) by by_m(Vec2d(x, y)).
  template <class Height>
  void Raise(const Height& by_m) {
    for (Eigen::Vector3f& vertex : vertices) vertex.z() += static_cast<float>(by_m(vertex.head<2>().cast<double>()));
  }
};

using TownMesh = std::array<Mesh, kSurfaces>;
inline Mesh& Of(TownMesh& mesh, Surface surface) {
  return mesh[static_cast<std::size_t>(surface)];
}
inline const Mesh& Of(const TownMesh& mesh, Surface surface) {
  return mesh[static_cast<std::size_t>(surface)];
}

// Corners of a rectangle around `centre`, counter-clockwise; `along` is of unit length.
Polyline Rectangle(const Vec2d& centre, const Vec2d& along, double half_length, double half_width);

// Only what stands this close to a route gets windows, doors and balconies.
inline constexpr double kDetailedWithin_m = 70;

// Everything in `sight`, in detail where it is `close`, that is the same in every drive: ground, roads, buildings,
// barriers, trees and the roadside of roadside.hpp. On flat ground. Depends on the arguments only.
TownMesh BuildTownMesh(const Town& town, const Sight& sight, const Sight& close);

}  // namespace mapweld::sim
