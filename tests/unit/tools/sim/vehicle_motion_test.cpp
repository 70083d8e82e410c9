// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/vehicle_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace mapweld::sim {
namespace {

// Right angles both ways, a sharp corner and the kinks of a roughly drawn street.
const Polyline kStreet{{0, 0}, {120, 0}, {120, 80}, {200, 90}, {230, 84}, {260, 96}, {330, 95}, {300, 20}, {300, -60}};

class Motion : public testing::Test {
 protected:
  const LanePath lane_ = LanePath::Beside(kStreet);
  const VehicleMotion motion_{lane_, DrivingStyle{}, Relief(0, 1), 42};
};

TEST_F(Motion, KeepsTheLimitsOfItsDrivingStyle) {
  const UniformSpline<1> travelled = PlanSpeed(lane_, DrivingStyle{});
  double top_speed = 0;
  for (double t = 0; t < travelled.end(); t += 0.013) {
    const double s = travelled.Value(t).x();
    const double speed = travelled.Derivative(t).x();
    ASSERT_GE(speed, -1e-9) << t;
    ASSERT_LE(speed, 10.0 + 1e-9) << t;
    ASSERT_LE(std::abs(travelled.SecondDerivative(t).x()), 1.5) << t;
    ASSERT_LE(speed * speed * std::abs(lane_.Curvature(s)), 2.0) << t;
    top_speed = std::max(top_speed, speed);
  }
  EXPECT_GT(top_speed, 9);
  EXPECT_NEAR(travelled.Value(travelled.end()).x(), lane_.length_m(), 1e-6);
}

TEST_F(Motion, NeverTurnsTighterThanACar) {
  for (double s = 0; s <= lane_.length_m(); s += 0.1) {
    ASSERT_LE(std::abs(lane_.Curvature(s)), 1 / LanePath::kMinRadius_m) << s;
  }
}

TEST_F(Motion, DrivesInTheRightHandLane) {
  const Vec2d on_first_street = lane_.Position(60);
  EXPECT_NEAR(on_first_street.y(), -LaneHabit{}.offset_m, 0.5);
  EXPECT_NEAR(lane_.Position(0).y(), -LaneHabit{}.offset_m, 0.05);
}

TEST_F(Motion, StandsStillAtBothEnds) {
  EXPECT_LT((motion_.WorldFromBody(2.9).t - motion_.WorldFromBody(0).t).norm(), 1e-6);
  EXPECT_LT((motion_.GyroBody(1.0)).norm(), 1e-6);
  EXPECT_NEAR((motion_.AccelBody(1.0) - geom::Vec3d(0, 0, kGravity_mps2)).norm(), 0, 1e-6);
  const double end = motion_.duration_s();
  EXPECT_LT((motion_.WorldFromBody(end).t - motion_.WorldFromBody(end - 1.9).t).head<2>().norm(), 1e-3);
}

TEST_F(Motion, HasNoJumpsInWhatTheImuMeasures) {
  constexpr double kStep_s = 1e-4;
  for (double t = 0; t + kStep_s < motion_.duration_s(); t += 0.0037) {
    ASSERT_LT((motion_.AccelBody(t + kStep_s) - motion_.AccelBody(t)).norm(), 0.02) << t;
    ASSERT_LT((motion_.GyroBody(t + kStep_s) - motion_.GyroBody(t)).norm(), 0.005) << t;
  }
}

TEST_F(Motion, LeansOutwardsAndDipsWhenBraking) {
  // Without the shaking's phases the sign is certain where the demand is large.
  double most_left = 0;
  double roll_there = 0;
  for (double t = 0; t < motion_.duration_s(); t += 0.02) {
    const geom::Pose3 world_T_body = motion_.WorldFromBody(t);
    const geom::Vec3d accel = world_T_body.q.conjugate() * motion_.AccelWorld(t);
    if (accel.y() > most_left) {
      most_left = accel.y();
      roll_there = std::asin((world_T_body.q * geom::Vec3d::UnitY()).z());
    }
  }
  EXPECT_GT(most_left, 1.0);
  EXPECT_GT(roll_there, 0.004);  // the left side rises
}

// The IMU values integrated as a strapdown navigator does must give the poses back: signs, frames and gravity agree.
TEST_F(Motion, IsReproducedByIntegratingItsImuValues) {
  constexpr double kStep_s = 1.0 / 200;
  const geom::Vec3d gravity(0, 0, -kGravity_mps2);
  for (const double begin : {1.0, 12.0, 25.0, 40.0}) {
    geom::Pose3 pose = motion_.WorldFromBody(begin);
    geom::Vec3d velocity = motion_.VelocityWorld(begin);
    for (int i = 0; i < 2000; ++i) {
      const double t = begin + i * kStep_s;
      const geom::Vec3d gyro = motion_.GyroBody(t + kStep_s / 2);
      const geom::Quatd half = pose.q * geom::ExpSo3(gyro * kStep_s / 2);
      const geom::Vec3d accel = half * motion_.AccelBody(t + kStep_s / 2) + gravity;
      pose.t += velocity * kStep_s + 0.5 * accel * kStep_s * kStep_s;
      velocity += accel * kStep_s;
      pose.q = (pose.q * geom::ExpSo3(gyro * kStep_s)).normalized();
    }
    const geom::Pose3 truth = motion_.WorldFromBody(begin + 10);
    EXPECT_LT((pose.t - truth.t).norm(), 0.02) << begin;
    EXPECT_LT(geom::LogSo3(truth.q.conjugate() * pose.q).norm(), 1e-4) << begin;
    EXPECT_LT((velocity - motion_.VelocityWorld(begin + 10)).norm(), 0.005) << begin;
  }
}

}  // namespace
}  // namespace mapweld::sim
