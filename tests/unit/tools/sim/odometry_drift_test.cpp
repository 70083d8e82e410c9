// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/odometry_drift.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace mapweld::sim {
namespace {

// A bend of 1 km in steps of 1.5 m.
geom::Pose3 TruePose(int i) {
  const double angle = 0.002 * i;
  return {{300 + 750 * std::sin(angle), -750 * std::cos(angle), 20}, geom::ExpSo3({0, 0, angle})};
}
constexpr int kSteps = 667;

TEST(OdometryDrift, IsTheTruthInAnotherFrameWithoutErrors) {
  DriftingOdometry odometry({0, 0, 0, 0}, 7);
  const geom::Pose3 odom_T_world = odometry.Next(TruePose(0)) * TruePose(0).Inverse();
  for (int i = 1; i < kSteps; ++i) {
    const geom::Pose3 expected = odom_T_world * TruePose(i);
    const geom::Pose3 pose = odometry.Next(TruePose(i));
    ASSERT_LT((pose.t - expected.t).norm(), 1e-6);
    ASSERT_LT(pose.q.angularDistance(expected.q), 1e-6);
  }
}

TEST(OdometryDrift, GrowsToAFewPerMilleOfThePath) {
  double squares = 0;
  constexpr int kDrives = 60;
  for (std::uint64_t seed = 0; seed < kDrives; ++seed) {
    DriftingOdometry odometry({}, seed);
    const geom::Pose3 odom_T_world = odometry.Next(TruePose(0)) * TruePose(0).Inverse();
    geom::Pose3 last;
    for (int i = 1; i < kSteps; ++i) last = odometry.Next(TruePose(i));
    squares += (last.t - odom_T_world * TruePose(kSteps - 1).t).squaredNorm();
  }
  const double rms_share = std::sqrt(squares / kDrives) / 1000;
  EXPECT_GT(rms_share, 0.003);
  EXPECT_LT(rms_share, 0.007);
}

TEST(OdometryDrift, StartsNearlyLevelLookingAlongX) {
  DriftingOdometry odometry({}, 3);
  const geom::Pose3 first = odometry.Next({{5, 6, 7}, geom::ExpSo3({0, 0, 2.1})});
  EXPECT_NEAR(geom::Yaw(first.q), 0, 1e-3);
  EXPECT_LT(first.t.norm(), 1e-9);
}

}  // namespace
}  // namespace mapweld::sim
