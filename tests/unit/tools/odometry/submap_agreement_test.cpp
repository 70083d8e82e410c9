// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/submap_agreement.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace mapweld::odometry {
namespace {

// A wall along the street, 8 m to the left of x = 0 in the world, as seen from (x, 0) with the given heading.
PlacedSubmap WallFrom(double x, double heading_rad, float height_m) {
  PlacedSubmap submap{{{x, 0, 0}, geom::Quatd(Eigen::AngleAxisd(heading_rad, geom::Vec3d::UnitZ()))}, {}};
  const geom::Pose3 level_T_world = submap.world_T_level.Inverse();
  for (double along = -30; along <= 30; along += 0.5) {
    for (float z = 0.25F; z < height_m; z += 0.5F) {
      submap.points.push_back((level_T_world * geom::Vec3d(along + 0.25, 8.25, static_cast<double>(z))).cast<float>());
    }
  }
  return submap;
}

TEST(SubmapAgreement, TheSameWallFromBothDirectionsAgrees) {
  const BothWays both = CompareSubmaps({WallFrom(0, 0, 4)}, {WallFrom(3, M_PI, 4)});
  EXPECT_EQ(both.same_way.pairs, 0U);
  ASSERT_EQ(both.opposite.pairs, 1U);
  EXPECT_DOUBLE_EQ(both.opposite.a_in_b, 1);
  EXPECT_DOUBLE_EQ(both.opposite.b_in_a, 1);
  EXPECT_GT(both.opposite.same_voxel, 0.95);
}

TEST(SubmapAgreement, WhatOnlyOneOfThemSawIsNotShared) {
  const BothWays both = CompareSubmaps({WallFrom(0, 0, 8)}, {WallFrom(0, 0, 4)});
  ASSERT_EQ(both.same_way.pairs, 1U);
  EXPECT_NEAR(both.same_way.a_in_b, 9.0 / 16, 1e-9);  // the row above is still within an edge
  EXPECT_DOUBLE_EQ(both.same_way.b_in_a, 1);
  EXPECT_NEAR(both.same_way.same_voxel, 0.5, 0.02);
}

TEST(SubmapAgreement, PlacesApartAndSideStreetsAreNotCompared) {
  const BothWays both = CompareSubmaps({WallFrom(0, 0, 4)}, {WallFrom(5, 0, 4), WallFrom(0, M_PI / 2, 4)});
  EXPECT_EQ(both.same_way.pairs + both.opposite.pairs, 0U);
}

}  // namespace
}  // namespace mapweld::odometry
