// SPDX-License-Identifier: Apache-2.0
// A room of which every distance is known: four walls, far enough apart to be driven through, and a floor. Nothing
// about it is symmetric.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/geom/pose3.hpp"
#include "tools/sim/town_mesh.hpp"

namespace mapweld::sim {

inline TownMesh Hall() {
  TownMesh mesh;
  Of(mesh, Surface::kWall).AddWalls({{-40, -20}, {100, -20}, {100, 30}, {-40, 30}}, -1, 60);
  Of(mesh, Surface::kRoad).AddFace({{-40, -20}, {100, -20}, {100, 30}, {-40, 30}}, 0);
  return mesh;
}

inline double DistanceToHall(const geom::Vec3d& p) {
  return std::min(
      {std::abs(p.x() + 40), std::abs(p.x() - 100), std::abs(p.y() + 20), std::abs(p.y() - 30), std::abs(p.z())});
}

}  // namespace mapweld::sim
