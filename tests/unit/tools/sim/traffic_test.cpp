// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/traffic.hpp"

#include <gtest/gtest.h>

namespace mapweld::sim {
namespace {

class OnTheRoad : public testing::Test {
 protected:
  const LanePath lane_ = LanePath::Beside({{0, 0}, {800, 0}});
  const Relief flat_{0, 1};
  const VehicleMotion motion_{lane_, DrivingStyle{}, flat_, 1};
  const Traffic traffic_{lane_, motion_, flat_, 1, 9};
};

TEST_F(OnTheRoad, MeetsMovingThingsThatKeepTheirShape) {
  std::size_t vertices = 0;
  double farthest = 0;
  for (double t = 0; t < motion_.duration_s(); t += 1) {
    const Traffic::Moving moving = traffic_.Between(t, t + 0.1);
    for (std::size_t kind = 0; kind < kSurfaces; ++kind) {
      ASSERT_EQ(moving.begin[kind].vertices.size(), moving.end[kind].vertices.size());
      ASSERT_EQ(moving.begin[kind].triangles, moving.end[kind].triangles);
      vertices += moving.begin[kind].vertices.size();
      for (std::size_t i = 0; i < moving.begin[kind].vertices.size(); ++i) {
        const double moved = (moving.end[kind].vertices[i] - moving.begin[kind].vertices[i]).norm();
        ASSERT_LT(moved, 2.5) << "in a tenth of a second";
        farthest = std::max(farthest, moved);
      }
    }
  }
  EXPECT_GT(vertices, 5000U);
  EXPECT_GT(farthest, 0.7);
}

TEST_F(OnTheRoad, NeverRunsIntoTheVehicle) {
  for (double t = 0; t < motion_.duration_s(); t += 0.5) {
    const Traffic::Moving moving = traffic_.Between(t, t + 0.1);
    const geom::Pose3 body_T_world = motion_.WorldFromBody(t).Inverse();
    for (const Mesh& kind : moving.begin) {
      for (const Eigen::Vector3f& vertex : kind.vertices) {
        const geom::Vec3d p = body_T_world * geom::Vec3d(vertex.cast<double>());
        ASSERT_FALSE(std::abs(p.x()) < 2.2 && std::abs(p.y()) < 0.9) << p.transpose() << " at " << t;
      }
    }
  }
}

TEST_F(OnTheRoad, IsEmptyWhenNobodyElseDrives) {
  const Traffic nobody(lane_, motion_, flat_, 0, 9);
  for (double t = 0; t < motion_.duration_s(); t += 5) {
    for (const Mesh& kind : nobody.Between(t, t + 0.1).begin) EXPECT_TRUE(kind.vertices.empty());
  }
}

}  // namespace
}  // namespace mapweld::sim
