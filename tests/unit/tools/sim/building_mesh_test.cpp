// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/building_mesh.hpp"

#include <gtest/gtest.h>

#include "tools/sim/ray_caster.hpp"

namespace mapweld::sim {
namespace {

Building House(RoofShape roof) {
  return {77, {{0, 0}, {12, 0}, {12, 8}, {0, 8}}, 8, roof};
}

// Where sixteen rays of one direction meet the house, spread over a line of starting points.
std::vector<float> Distances(const TownMesh& mesh, const Eigen::Vector3f& from, const Eigen::Vector3f& step,
                             const Eigen::Vector3f& direction) {
  const RayCaster caster({std::make_shared<RayScene>(mesh)});
  RayPacket rays{};
  for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
    const Eigen::Vector3f origin = from + static_cast<float>(i) * step;
    rays.origin_x[i] = origin.x();
    rays.origin_y[i] = origin.y();
    rays.origin_z[i] = origin.z();
    rays.direction_x[i] = direction.x();
    rays.direction_y[i] = direction.y();
    rays.direction_z[i] = direction.z();
  }
  caster.Cast(rays, 100);
  return {rays.distance_m.begin(), rays.distance_m.end()};
}

TEST(House, IsClosedAboveWhateverItsRoof) {
  for (const RoofShape roof : {RoofShape::kFlat, RoofShape::kGable, RoofShape::kHip}) {
    for (const bool detailed : {false, true}) {
      TownMesh mesh;
      AddBuilding(House(roof), detailed, mesh);
      for (const float y : {0.5F, 3.0F, 5.5F, 7.5F}) {
        for (const float d : Distances(mesh, {0.3F, y, 50}, {0.75F, 0, 0}, {0, 0, -1})) {
          EXPECT_GE(d, 42 - 1e-3F) << "not above the ridge";
          EXPECT_LT(d, 47) << "and above the eaves";
        }
      }
    }
  }
}

TEST(House, HasItsRidgeAtItsHeightAndLowerEavesUnderAGable) {
  TownMesh mesh;
  AddBuilding(House(RoofShape::kGable), false, mesh);
  for (const float d : Distances(mesh, {0.3F, 4, 50}, {0.75F, 0, 0}, {0, 0, -1})) EXPECT_NEAR(d, 42, 1e-3);
  for (const float d : Distances(mesh, {0.3F, 0.05F, 50}, {0.75F, 0, 0}, {0, 0, -1})) EXPECT_GT(d, 43.5F);
}

TEST(House, HasWindowsSetBackIntoClosedWalls) {
  TownMesh mesh;
  AddBuilding(House(RoofShape::kFlat), true, mesh);
  EXPECT_GT(Of(mesh, Surface::kGlass).triangles.size(), 8U);
  int in_the_wall = 0;
  int in_a_window = 0;
  for (float z = 0.2F; z < 7.8F; z += 0.3F) {
    for (const float d : Distances(mesh, {0.2F, -10, z}, {0.77F, 0, 0}, {0, 1, 0})) {
      EXPECT_GT(d, 8.8F) << "nothing farther out than a balcony";
      EXPECT_LT(d, 10.6F) << "no way through";
      in_the_wall += std::abs(d - 10) < 1e-3F ? 1 : 0;
      in_a_window += d > 10.05F ? 1 : 0;
    }
  }
  EXPECT_GT(in_the_wall, 100);
  EXPECT_GT(in_a_window, 30);
}

}  // namespace
}  // namespace mapweld::sim
