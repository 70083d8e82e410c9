// SPDX-License-Identifier: Apache-2.0
#include "core/lio/imu_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace mapweld::lio {
namespace {

sensor::ImuSample At(int i, const geom::Vec3d& gyro, const geom::Vec3d& accel) {
  return {{i * 5'000'000LL}, gyro, accel, false};
}

TEST(ImuAlignment, FindsDownAndTheGyroOffsetAtRest) {
  const geom::Quatd local_R_body(Eigen::AngleAxisd(0.05, geom::Vec3d::UnitY()) *
                                 Eigen::AngleAxisd(-0.1, geom::Vec3d::UnitX()));
  const geom::Vec3d accel = local_R_body.conjugate() * geom::Vec3d(0, 0, 9.79);
  ImuAlignment alignment;
  Status status = Status::kNotReady;
  for (int i = 0; status == Status::kNotReady && i < 1000; ++i) {
    status = alignment.Add(At(i, {0.001, -0.002, 0.003}, accel));
  }
  ASSERT_EQ(status, Status::kOk);
  EXPECT_LT(alignment.alignment().local_R_body.angularDistance(local_R_body), 2e-3);
  EXPECT_NEAR(alignment.alignment().gyro_bias.z(), 0.003, 1e-9);
  EXPECT_NEAR(alignment.alignment().gravity_m_s2, 9.79, 1e-9);
  EXPECT_NEAR(geom::Yaw(alignment.alignment().local_R_body), 0, 1e-12);
}

TEST(ImuAlignment, WaitsSomeSecondsForTheVehicleToStop) {
  ImuAlignment alignment;
  for (int i = 0; i < 900; ++i) {
    const double wobble = std::sin(0.05 * i);
    ASSERT_EQ(alignment.Add(At(i, {0, 0, 0.3 * wobble}, {wobble, 0, 9.81})), Status::kNotReady);
  }
  Status status = Status::kNotReady;
  for (int i = 900; status == Status::kNotReady && i < 3000; ++i)
    status = alignment.Add(At(i, {0, 0, 0}, {0, 0, 9.81}));
  EXPECT_EQ(status, Status::kOk);
  EXPECT_FALSE(alignment.alignment().moving);
}

TEST(ImuAlignment, KnowsAnIdlingEngineFromDriving) {
  ImuAlignment alignment;
  Status status = Status::kNotReady;
  int samples = 0;
  for (; status == Status::kNotReady && samples < 3000; ++samples) {
    const double shaking = std::sin(2 * 3.14159 * 27.0 * 0.005 * samples);
    status = alignment.Add(At(samples, {0.04 * shaking, 0, 0.002}, {0, 1.0 * shaking, 9.81 + 2.0 * shaking}));
  }
  ASSERT_EQ(status, Status::kOk);
  EXPECT_FALSE(alignment.alignment().moving);
  EXPECT_LE(samples, 202) << "as fast as without the engine";
  EXPECT_LT(alignment.alignment().local_R_body.angularDistance(geom::Quatd::Identity()), 5e-3);
  EXPECT_NEAR(alignment.alignment().gyro_bias.z(), 0.002, 1e-9);
}

TEST(ImuAlignment, StartsInMotionWhenItNeverStops) {
  ImuAlignment alignment;
  Status status = Status::kNotReady;
  for (int i = 0; status == Status::kNotReady && i < 3000; ++i) {
    const double wobble = std::sin(0.05 * i);
    status = alignment.Add(At(i, {0, 0, 0.3 * wobble}, {wobble, 0, 9.81}));
  }
  ASSERT_EQ(status, Status::kOk);
  EXPECT_TRUE(alignment.alignment().moving);
  EXPECT_LT(alignment.alignment().local_R_body.angularDistance(geom::Quatd::Identity()), 0.02);
}

TEST(ImuAlignment, RefusesAnAccelerometerThatDoesNotMeasureGravity) {
  ImuAlignment alignment;
  bool refused = false;
  for (int i = 0; i < 400; ++i) refused |= alignment.Add(At(i, {0, 0, 0}, {0, 0, 1.0})) == Status::kOutOfRange;
  EXPECT_TRUE(refused);
}

TEST(ImuAlignment, RefusesAnAccelerometerThatHangsUpsideDownOrOnItsSide) {
  for (const geom::Vec3d& force : {geom::Vec3d(0, 0, -9.81), geom::Vec3d(9.81, 0, 0)}) {
    ImuAlignment alignment;
    for (int i = 0; i < 3000; ++i) ASSERT_NE(alignment.Add(At(i, {0, 0, 0}, force)), Status::kOk);
  }
}

}  // namespace
}  // namespace mapweld::lio
