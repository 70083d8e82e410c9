// SPDX-License-Identifier: Apache-2.0
// First hits of rays in a town, by Embree.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "tools/sim/town_mesh.hpp"

namespace mapweld::sim {

// Sixteen rays at once, one array per coordinate as the hardware wants them. Directions are of unit length.
struct alignas(64) RayPacket {
  static constexpr std::size_t kRays = 16;
  std::array<float, kRays> origin_x, origin_y, origin_z;
  std::array<float, kRays> direction_x, direction_y, direction_z;
  // Results
  std::array<float, kRays> distance_m;     // 0: no hit
  std::array<float, kRays> cos_incidence;  // 1: perpendicular
  std::array<std::uint32_t, kRays> patch;  // the same number for all hits on one flat face of one kind
  std::array<Surface, kRays> surface;
};

class RayCaster {
 public:
  // Copies the triangles and builds the search tree, in one thread so that it is always the same tree.
  explicit RayCaster(const TownMesh& mesh);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  // May be called by many threads at once.
  void Cast(RayPacket& rays, float max_range_m) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace mapweld::sim
