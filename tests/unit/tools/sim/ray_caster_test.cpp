// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/ray_caster.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace mapweld::sim {
namespace {

using Layers = std::vector<std::shared_ptr<const RayScene>>;

// 40 x 40 leafy patches of 10 cm in the plane x = `at`, y and z from 0 to 4.
TownMesh Bush(double at) {
  TownMesh mesh;
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 40; ++k) {
      const double y = 0.1 * i;
      const double z = 0.1 * k;
      Of(mesh, Surface::kFoliage).AddQuad({at, y, z}, {at, y + 0.1, z}, {at, y + 0.1, z + 0.1}, {at, y, z + 0.1});
    }
  }
  return mesh;
}

TownMesh Wall(double at) {
  TownMesh mesh;
  Of(mesh, Surface::kWall).AddQuad({at, -1, -1}, {at, 5, -1}, {at, 5, 5}, {at, -1, 5});
  return mesh;
}

// One ray along x through the middle of every patch.
std::vector<float> Look(const RayCaster& caster) {
  std::vector<float> distances;
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 40; k += 10) {
      RayPacket rays{};
      for (std::size_t ray = 0; ray < RayPacket::kRays; ++ray) {
        rays.origin_y[ray] = 0.1F * static_cast<float>(i) + 0.04F;
        rays.origin_z[ray] = 0.1F * static_cast<float>(k + static_cast<int>(ray) % 10) + 0.03F;
        rays.direction_x[ray] = 1;
      }
      caster.Cast(rays, 100);
      distances.insert(distances.end(), rays.distance_m.begin(), rays.distance_m.begin() + 10);
    }
  }
  return distances;
}

double Share(const std::vector<float>& distances, float at) {
  int n = 0;
  for (const float d : distances) n += std::abs(d - at) < 1e-3F ? 1 : 0;
  return static_cast<double>(n) / static_cast<double>(distances.size());
}

TEST(RayCaster, TakesTheNearestOfAllLayers) {
  const auto near = std::make_shared<RayScene>(Wall(7));
  const auto far = std::make_shared<RayScene>(Wall(9));
  EXPECT_EQ(Share(Look(RayCaster(Layers{near, far})), 7), 1);
  EXPECT_EQ(Share(Look(RayCaster(Layers{far, near})), 7), 1);
  EXPECT_EQ(Share(Look(RayCaster(Layers{far})), 9), 1);
}

TEST(RayCaster, SeesThroughTheShareOfLeavesThatIsMissing) {
  const Layers layers{std::make_shared<RayScene>(Bush(5)), std::make_shared<RayScene>(Wall(7))};
  EXPECT_EQ(Share(Look(RayCaster(layers)), 5), 1);
  const auto summer = Look(RayCaster(layers, {1, 0.7}));
  EXPECT_NEAR(Share(summer, 5), 0.7, 0.05);
  EXPECT_NEAR(Share(summer, 7), 0.3, 0.05) << "what passes the leaves hits the wall";
  EXPECT_EQ(summer, Look(RayCaster(layers, {1, 0.7})));
  EXPECT_NE(summer, Look(RayCaster(layers, {2, 0.7}))) << "other leaves in another drive";
  EXPECT_EQ(Share(Look(RayCaster(layers, {1, 0})), 7), 1) << "only leaves fall";
}

}  // namespace
}  // namespace mapweld::sim
