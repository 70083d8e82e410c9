// SPDX-License-Identifier: Apache-2.0
#include "core/geom/pose3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace mapweld::geom {
namespace {

Vec6d RandomVector(std::mt19937* rng, double scale) {
  std::normal_distribution<double> normal(0, scale);
  Vec6d v;
  for (int i = 0; i < 6; ++i) v(i) = normal(*rng);
  return v;
}

TEST(So3, LogUndoesExpForEveryAngleUpToPi) {
  std::mt19937 rng(1);
  for (double angle : {0.0, 1e-9, 1e-5, 0.1, 1.0, 3.0, std::numbers::pi - 1e-6}) {
    const Vec3d axis = RandomVector(&rng, 1).head<3>().normalized();
    EXPECT_LT((LogSo3(ExpSo3(angle * axis)) - angle * axis).norm(), 1e-9) << angle;
  }
}

TEST(So3, RightJacobianIsTheDerivativeOfExp) {
  std::mt19937 rng(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Vec3d phi = RandomVector(&rng, 1).head<3>();
    const Mat3d j = RightJacobianSo3(phi);
    const double h = 1e-6;
    for (int k = 0; k < 3; ++k) {
      const Vec3d numeric = LogSo3((ExpSo3(phi).conjugate() * ExpSo3(phi + h * Vec3d::Unit(k))).normalized()) / h;
      EXPECT_LT((numeric - j.col(k)).norm(), 1e-5);
    }
    EXPECT_LT((j * RightJacobianInverseSo3(phi) - Mat3d::Identity()).norm(), 1e-9);
  }
}

TEST(Pose3, ComposesInTheOrderItsNameReads) {
  const Pose3 a_T_b{{1, 0, 0}, ExpSo3({0, 0, std::numbers::pi / 2})};
  const Pose3 b_T_c{{0, 2, 0}, ExpSo3({0, 0, 0.3})};
  const Vec3d p_c(0.5, -1, 2);
  EXPECT_LT(((a_T_b * b_T_c) * p_c - a_T_b * (b_T_c * p_c)).norm(), 1e-12);
  EXPECT_LT((a_T_b * Vec3d(1, 0, 0) - Vec3d(1, 1, 0)).norm(), 1e-12);
  EXPECT_LT(((a_T_b.Inverse() * a_T_b) * p_c - p_c).norm(), 1e-12);
}

TEST(Pose3, RetractUndoesLocalCoordinates) {
  std::mt19937 rng(3);
  for (int trial = 0; trial < 50; ++trial) {
    const Pose3 a = Retract({}, RandomVector(&rng, 1));
    const Pose3 b = Retract({}, RandomVector(&rng, 1));
    const Pose3 back = Retract(a, LocalCoordinates(a, b));
    EXPECT_LT((back.t - b.t).norm(), 1e-10);
    EXPECT_LT(back.q.angularDistance(b.q), 1e-7);
  }
}

TEST(Pose3, LevelKeepsPositionAndHeadingAndStandsUpright) {
  const Pose3 pose{{3, 4, 5},
                   Quatd(Eigen::AngleAxisd(1.2, Vec3d::UnitZ()) * Eigen::AngleAxisd(0.05, Vec3d::UnitY()) *
                         Eigen::AngleAxisd(-0.1, Vec3d::UnitX()))};
  const Pose3 level = Level(pose);
  EXPECT_EQ(level.t, pose.t);
  EXPECT_LT((level.q * Vec3d::UnitZ() - Vec3d::UnitZ()).norm(), 1e-12);
  EXPECT_NEAR(Yaw(level.q), 1.2, 1e-12);
}

TEST(Pose3, RefusesNanAndQuaternionsThatAreNotRotations) {
  Pose3 pose;
  EXPECT_TRUE(pose.IsValid());
  pose.q.coeffs().setZero();
  EXPECT_FALSE(pose.IsValid());
  pose = {};
  pose.t.y() = std::nan("");
  EXPECT_FALSE(pose.IsValid());
}

}  // namespace
}  // namespace mapweld::geom
