// SPDX-License-Identifier: Apache-2.0
#include "core/lio/degeneracy.hpp"

#include <gtest/gtest.h>

namespace mapweld::lio {
namespace {

geom::Vec6d Numbers(double x, double y, double z, double rx, double ry, double rz) {
  geom::Vec6d v;
  v << x, y, z, rx, ry, rz;
  return v;
}

TEST(Degeneracy, LeavesAWellDeterminedScanAlone) {
  geom::Mat6d information = Numbers(1e5, 1e5, 1e5, 1e7, 1e7, 1e7).asDiagonal();
  geom::Vec6d gradient = geom::Vec6d::Ones();
  const geom::Mat6d before = information;
  const Degeneracy found = RemoveOpenDirections({}, {}, &information, &gradient);
  EXPECT_FALSE(found.any());
  EXPECT_DOUBLE_EQ(found.position_information, 1e5);
  EXPECT_EQ(information, before);
  EXPECT_EQ(gradient, geom::Vec6d::Ones());
}

TEST(Degeneracy, TakesAwayOnlyTheDirectionAlongACorridor) {
  // The corridor runs at 30 degrees to x.
  const geom::Mat3d turn = Eigen::AngleAxisd(0.5, geom::Vec3d::UnitZ()).toRotationMatrix();
  geom::Mat6d information = Numbers(0, 0, 0, 1e7, 1e7, 1e7).asDiagonal();
  information.topLeftCorner<3, 3>() = turn * geom::Vec3d(50, 1e5, 1e5).asDiagonal() * turn.transpose();
  geom::Vec6d gradient = geom::Vec6d::Zero();
  gradient.head<3>() = turn * geom::Vec3d(7, 8, 9);
  const Degeneracy found = RemoveOpenDirections({}, {}, &information, &gradient);
  EXPECT_EQ(found.open_positions, 1);
  EXPECT_EQ(found.open_rotations, 0);
  EXPECT_NEAR(found.position_information, 50, 1e-6);
  EXPECT_LT((turn.transpose() * gradient.head<3>() - geom::Vec3d(0, 8, 9)).norm(), 1e-9);
  EXPECT_NEAR((turn.transpose() * information.topLeftCorner<3, 3>() * turn)(0, 0), 0, 1e-6);
  EXPECT_NEAR((turn.transpose() * information.topLeftCorner<3, 3>() * turn)(1, 1), 1e5, 1e-6);
}

TEST(Degeneracy, KeepsWeakEvidenceThatStandsOutOfTheNoiseOfTheNormals) {
  const geom::Mat6d weak = Numbers(500, 1e5, 1e5, 1e7, 1e7, 1e7).asDiagonal();
  for (const double noise : {50.0, 400.0}) {
    geom::Mat6d information = weak;
    geom::Vec6d gradient = geom::Vec6d::Ones();
    const Degeneracy found = RemoveOpenDirections({}, {.position = noise}, &information, &gradient);
    EXPECT_EQ(found.open_positions, noise < 100 ? 0 : 1);
    EXPECT_NEAR(gradient(0), noise < 100 ? 1 : 0, 1e-12);
  }
}

TEST(Degeneracy, AnOpenFieldLeavesTwoPositionsAndTheHeadingOpen) {
  geom::Mat6d information = Numbers(10, 20, 1e5, 1e7, 1e7, 50).asDiagonal();
  geom::Vec6d gradient = geom::Vec6d::Ones();
  const Degeneracy found = RemoveOpenDirections({}, {}, &information, &gradient);
  EXPECT_EQ(found.open_positions, 2);
  EXPECT_EQ(found.open_rotations, 1);
  EXPECT_LT((gradient - Numbers(0, 0, 1, 1, 1, 0)).norm(), 1e-9);
}

}  // namespace
}  // namespace mapweld::lio
