// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/unit/tools/merge/synthetic_town.hpp"
#include "tools/merge/voxel_mean.hpp"

namespace mapweld::merge {
namespace {

using geom::Pose3;
using geom::Vec3d;

class RecordingTest : public ::testing::Test {
 protected:
  RecordingTest() : town_(8) {
    town_.AddStreet({-60, 0}, 200);
    drive_ = DriveAlong(town_, "bus", 0, 90, 0, 5);
  }
  SyntheticTown town_;
  TownDrive drive_;
};

TEST_F(RecordingTest, PlacesAKeyframeEveryFiveMetresOfPath) {
  const RecordedDrive built = BuildDrive(drive_.recording, {}, nullptr);
  ASSERT_GE(built.drive.keyframes.size(), 14U);
  for (std::size_t k = 1; k < built.drive.keyframes.size(); ++k) {
    const double step_m = built.drive.keyframes[k].path_m - built.drive.keyframes[k - 1].path_m;
    EXPECT_GE(step_m, 3.4);
    EXPECT_LT(step_m, 6.6);
  }
  EXPECT_EQ(built.submaps.size(), built.drive.keyframes.size());
  EXPECT_GT(built.drive.keyframes[5].place.descriptor.scale, 0);
}

TEST_F(RecordingTest, TurnsTheFrameSoThatZIsUp) {
  const RecordedDrive built = BuildDrive(drive_.recording, {}, nullptr);
  for (const Keyframe& keyframe : built.drive.keyframes) {
    EXPECT_GT((keyframe.odom_T_body.q * Vec3d::UnitZ()).z(), 0.9999);
    EXPECT_NEAR(keyframe.odom_T_body.t.z(), 0, 0.2);
  }
}

TEST_F(RecordingTest, PutsTheGroundBelowAndTheHousesBesideTheVehicle) {
  const RecordedDrive built = BuildDrive(drive_.recording, {}, nullptr);
  const std::vector<Eigen::Vector3f>& points = built.submaps[8].points;
  ASSERT_GT(points.size(), 2000U);
  int ground = 0;
  for (const Eigen::Vector3f& p : points) {
    EXPECT_LE(p.head<2>().norm(), 50.01F);
    EXPECT_GT(p.z(), -2.4F);
    ground += p.head<2>().norm() < 3 && std::abs(p.z() + 1.8F) < 0.2F ? 1 : 0;
  }
  EXPECT_GT(ground, 15);
}

TEST_F(RecordingTest, GivesTheSameForAnyNumberOfThreads) {
  RecordingConfig one;
  one.threads = 1;
  RecordingConfig many;
  many.threads = 7;
  const RecordedDrive x = BuildDrive(drive_.recording, one, nullptr);
  const RecordedDrive y = BuildDrive(drive_.recording, many, nullptr);
  ASSERT_EQ(x.submaps.size(), y.submaps.size());
  for (std::size_t k = 0; k < x.submaps.size(); ++k) {
    EXPECT_TRUE(x.submaps[k].points == y.submaps[k].points) << k;
    EXPECT_EQ(x.drive.keyframes[k].place.descriptor.q, y.drive.keyframes[k].place.descriptor.q) << k;
  }
}

TEST_F(RecordingTest, MarksKeyframesWhoseSubmapTheEndCutShort) {
  const RecordedDrive built = BuildDrive(drive_.recording, {}, nullptr);
  EXPECT_FALSE(built.drive.keyframes.front().flushed);
  EXPECT_TRUE(built.drive.keyframes.back().flushed);
}

TEST_F(RecordingTest, CarriesTheCorrectionOfTheKeyframesToEveryScan) {
  const RecordedDrive built = BuildDrive(drive_.recording, {}, nullptr);
  const Pose3 merged_T_odom{{100, 20, -3}, geom::ExpSo3({0, 0, 1.1})};
  std::vector<Pose3> merged;
  for (const Keyframe& keyframe : built.drive.keyframes) merged.push_back(merged_T_odom * keyframe.odom_T_body);
  const std::vector<Pose3> scans = MergedScanPoses(built, merged);
  ASSERT_EQ(scans.size(), built.odom_T_scan.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Pose3 expected = merged_T_odom * built.odom_T_scan[i];
    EXPECT_LT((scans[i].t - expected.t).norm(), 1e-9);
    EXPECT_LT(scans[i].q.angularDistance(expected.q), 1e-9);
  }
}

TEST_F(RecordingTest, BendsWithoutAStepBetweenScans) {
  const RecordedDrive built = BuildDrive(drive_.recording, {}, nullptr);
  std::vector<Pose3> merged;
  for (std::size_t k = 0; k < built.drive.keyframes.size(); ++k) {
    merged.push_back(Pose3{{0, 0.3 * static_cast<double>(k % 2), 0}, {}} * built.drive.keyframes[k].odom_T_body);
  }
  const std::vector<Pose3> scans = MergedScanPoses(built, merged);
  for (std::size_t i = 1; i < scans.size(); ++i) {
    const double extra_m =
        ((scans[i].t - scans[i - 1].t) - (built.odom_T_scan[i].t - built.odom_T_scan[i - 1].t)).norm();
    EXPECT_LT(extra_m, 0.15);
  }
}

TEST_F(RecordingTest, RefusesWhatIsNoRecording) {
  Recording bad = drive_.recording;
  bad.times.pop_back();
  EXPECT_THROW((void)BuildDrive(bad, {}, nullptr), std::runtime_error);
  bad = drive_.recording;
  bad.world_T_lidar[4].q.coeffs().setZero();
  EXPECT_THROW((void)BuildDrive(bad, {}, nullptr), std::runtime_error);
  bad = drive_.recording;
  bad.world_T_lidar.resize(1);
  bad.times.resize(1);
  EXPECT_THROW((void)BuildDrive(bad, {}, nullptr), std::runtime_error);
}

TEST(VoxelMeans, AreOnePointPerVoxelInAFixedOrder) {
  const std::vector<Eigen::Vector3f> points = {{0.1F, 0.1F, 0.1F}, {0.3F, 0.3F, 0.3F}, {-0.1F, 0, 0}, {9, 9, 9}};
  const auto means = [&](bool backwards) {
    VoxelMean voxels(0.5);
    for (std::size_t i = 0; i < points.size(); ++i) voxels.Add(points[backwards ? points.size() - 1 - i : i], 1);
    voxels.Add({std::nanf(""), 0, 0}, 1);
    std::vector<WeightedPoint> out;
    voxels.Take(&out);
    return out;
  };
  const auto x = means(false);
  const auto y = means(true);
  ASSERT_EQ(x.size(), 3U);
  ASSERT_EQ(y.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT((x[i].p - y[i].p).norm(), 1e-6);
  EXPECT_LT((x[1].p - Eigen::Vector3f(0.2F, 0.2F, 0.2F)).norm(), 1e-6);
}

}  // namespace
}  // namespace mapweld::merge
