// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/segment_error.hpp"

#include <gtest/gtest.h>

namespace mapweld::eval {
namespace {

// 10 m/s straight on for 100 s, with lengths scaled and the heading drifting.
std::vector<io::StampedPose> Straight(double scale, double yaw_per_m) {
  std::vector<io::StampedPose> poses;
  geom::Pose3 pose;
  const geom::Pose3 step{{scale, 0, 0}, geom::ExpSo3({0, 0, yaw_per_m})};
  for (int i = 0; i <= 1000; ++i) {
    poses.push_back({{i * 100'000'000LL}, pose});
    pose = pose * step;
  }
  return poses;
}

TEST(SegmentError, IsZeroForTheTruth) {
  const SegmentError error = SegmentDrift(Straight(1, 0), Straight(1, 0));
  EXPECT_GT(error.segments, 400U);
  EXPECT_NEAR(error.translation_percent, 0, 1e-9);
}

TEST(SegmentError, AWrongScaleIsItsPercentage) {
  EXPECT_NEAR(SegmentDrift(Straight(1, 0), Straight(1.01, 0)).translation_percent, 1.0, 1e-6);
}

TEST(SegmentError, ATurnIsItsDegreesPerMetre) {
  EXPECT_NEAR(SegmentDrift(Straight(1, 0), Straight(1, 1e-4)).rotation_deg_per_m, 1e-4 * 180 / M_PI, 1e-6);
}

TEST(SegmentError, AShortDriveHasNoSegments) {
  auto truth = Straight(1, 0);
  truth.resize(50);
  EXPECT_EQ(SegmentDrift(truth, truth).segments, 0U);
}

// 1 m a pose: over 10 m a scale of 1.01 is 0.1 m off, a turn of 1e-4 rad/m is 1e-3 rad.
TEST(RelativePoseError, IsWhatTenMetresAreOff) {
  EXPECT_NEAR(RelativePoseError(Straight(1, 0), Straight(1.01, 0)).translation_m, 0.1, 1e-9);
  EXPECT_NEAR(RelativePoseError(Straight(1, 0), Straight(1, 1e-4)).rotation_deg, 1e-3 * 180 / M_PI, 1e-6);
  EXPECT_EQ(RelativePoseError(Straight(1, 0), Straight(1, 0)).steps, 991U);
}

TEST(RelativePoseError, DoesNotMindWhereTheDriveLies) {
  auto moved = Straight(1, 1e-3);
  for (io::StampedPose& pose : moved)
    pose.world_T_body = geom::Pose3{{5, 6, 7}, geom::ExpSo3({1, 2, 3})} * pose.world_T_body;
  EXPECT_NEAR(RelativePoseError(Straight(1, 1e-3), moved).translation_m, 0, 1e-9);
}

TEST(GravityError, IsTheTiltWhateverTheHeading) {
  const std::vector<io::StampedPose> truth{{{0}, {}}};
  const geom::Quatd tilted(Eigen::AngleAxisd(1.0, geom::Vec3d::UnitZ()) *
                           Eigen::AngleAxisd(0.5 * M_PI / 180, geom::Vec3d::UnitX()));
  EXPECT_NEAR(GravityErrorsDeg(truth, {{{0}, {{1, 2, 3}, tilted}}})[0], 0.5, 1e-9);
}

}  // namespace
}  // namespace mapweld::eval
