// SPDX-License-Identifier: Apache-2.0
// First hits of rays in a town, by Embree.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "tools/sim/town_mesh.hpp"

namespace mapweld::sim {

// Sixteen rays at once, one array per coordinate as the hardware wants them. Directions are of unit length.
struct alignas(64) RayPacket {
  static constexpr std::size_t kRays = 16;
  std::array<float, kRays> origin_x, origin_y, origin_z;
  std::array<float, kRays> direction_x, direction_y, direction_z;
  std::array<float, kRays> time{};  // 0..1: when, of the moment that a moving scene covers
  // Results
  std::array<float, kRays> distance_m;     // 0: no hit
  std::array<float, kRays> cos_incidence;  // 1: perpendicular
  std::array<std::uint32_t, kRays> patch;  // the same number for all hits on one flat face of one kind
  std::array<Surface, kRays> surface;
};

// A search tree over triangles, shared by all that look at them.
class RayScene {
 public:
  // Copies the triangles and builds the tree, in one thread so that it is always the same tree.
  explicit RayScene(const TownMesh& mesh);
  // The same triangles moving evenly from one place to another while a ray's time goes from 0 to 1.
  RayScene(const TownMesh& begin, const TownMesh& end);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

 private:
  friend class RayCaster;
  struct Tree;
  void Build(const TownMesh& mesh, const TownMesh* end);
  std::unique_ptr<Tree> tree_;
};

// How leafy the trees are, and which of their leaves are there.
struct Foliage {
  std::uint64_t seed = 0;
  double density = 1;  // share of the leafy patches that stop a beam
};

// What one drive sees: scenes laid over each other, for example the town and the cars that are parked in it today.
class RayCaster {
 public:
  explicit RayCaster(std::vector<std::shared_ptr<const RayScene>> layers, Foliage foliage = {})
      : layers_(std::move(layers)), foliage_(foliage) {}

  // `moving`: one more layer, for these rays only; may be null. May be called by many threads at once.
  void Cast(RayPacket& rays, float max_range_m, const RayScene* moving = nullptr) const;

 private:
  std::vector<std::shared_ptr<const RayScene>> layers_;
  Foliage foliage_;
};

}  // namespace mapweld::sim
