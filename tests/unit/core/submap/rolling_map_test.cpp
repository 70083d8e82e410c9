// SPDX-License-Identifier: Apache-2.0
#include "core/submap/rolling_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace mapweld::submap {
namespace {

class RollingMapTest : public testing::Test {
 protected:
  std::unique_ptr<RollingMap> map_ = std::make_unique<RollingMap>();
  std::unique_ptr<Submap> submap_ = std::make_unique<Submap>();
};

TEST_F(RollingMapTest, CutsOnlyWhatLiesWithinTheRadius) {
  ASSERT_EQ(map_->Insert({10, 0, 1}, 0), Status::kOk);
  ASSERT_EQ(map_->Insert({49, 0, 1}, 0), Status::kOk);
  ASSERT_EQ(map_->Insert({51, 0, 1}, 0), Status::kOk);
  ASSERT_EQ(map_->Extract({}, 0, submap_.get()), Status::kOk);
  ASSERT_EQ(submap_->points.size(), 2U);
}

TEST_F(RollingMapTest, GivesTheMeanOfTheReturnsInAVoxel) {
  ASSERT_EQ(map_->Insert({10.1F, 0.1F, 0.1F}, 0), Status::kOk);
  ASSERT_EQ(map_->Insert({10.3F, 0.3F, 0.1F}, 0), Status::kOk);
  ASSERT_EQ(map_->Extract({}, 0, submap_.get()), Status::kOk);
  ASSERT_EQ(submap_->points.size(), 1U);
  EXPECT_NEAR(submap_->points[0].x, 10.2, 1e-3);
  EXPECT_NEAR(submap_->points[0].y, 0.2, 1e-3);
  EXPECT_EQ(submap_->points[0].count, 2);
}

TEST_F(RollingMapTest, PointsAreInTheLevelFrameOfTheKeyframe) {
  const geom::Pose3 odom_T_body{
      {100, 50, 2},
      geom::Quatd(Eigen::AngleAxisd(M_PI / 2, geom::Vec3d::UnitZ()) * Eigen::AngleAxisd(0.1, geom::Vec3d::UnitX()))};
  ASSERT_EQ(map_->Insert({100.2F, 60.2F, 3.2F}, 0), Status::kOk);  // 10 m ahead of a vehicle that faces +y
  ASSERT_EQ(map_->Extract(odom_T_body, 0, submap_.get()), Status::kOk);
  ASSERT_EQ(submap_->points.size(), 1U);
  EXPECT_NEAR(submap_->points[0].x, 10.2, 0.01);
  EXPECT_NEAR(submap_->points[0].y, -0.2, 0.01);
  EXPECT_NEAR(submap_->points[0].z, 1.2, 0.01);
}

TEST_F(RollingMapTest, LeavesOutWhatWasSeenOnAnotherStretchOfThePath) {
  ASSERT_EQ(map_->Insert({10, 0, 0}, 0), Status::kOk);
  ASSERT_EQ(map_->Insert({20, 0, 0}, 500), Status::kOk);
  ASSERT_EQ(map_->Extract({}, 500, submap_.get()), Status::kOk);
  ASSERT_EQ(submap_->points.size(), 1U);
  EXPECT_NEAR(submap_->points[0].x, 20, 0.01);
}

TEST_F(RollingMapTest, TheOrderOfInsertionDoesNotMatter) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> at(-45, 45);
  std::vector<Eigen::Vector3f> points(5000);
  for (auto& p : points) p = {at(rng), at(rng) * 0.5F, at(rng) * 0.1F};
  for (const auto& p : points) ASSERT_EQ(map_->Insert(p, 1), Status::kOk);
  ASSERT_EQ(map_->Extract({}, 1, submap_.get()), Status::kOk);
  auto other_map = std::make_unique<RollingMap>();
  auto other = std::make_unique<Submap>();
  std::shuffle(points.begin(), points.end(), rng);
  for (const auto& p : points) ASSERT_EQ(other_map->Insert(p, 1), Status::kOk);
  ASSERT_EQ(other_map->Extract({}, 1, other.get()), Status::kOk);
  ASSERT_EQ(submap_->points.size(), other->points.size());
  for (std::size_t i = 0; i < other->points.size(); ++i) {
    EXPECT_EQ(submap_->points[i].x, other->points[i].x);
    EXPECT_EQ(submap_->points[i].z, other->points[i].z);
  }
}

TEST_F(RollingMapTest, CutInStepsIsTheSameAsCutAtOnce) {
  std::mt19937 rng(2);
  std::uniform_real_distribution<float> at(-45, 45);
  for (int i = 0; i < 5000; ++i) ASSERT_EQ(map_->Insert({at(rng), at(rng), 0.1F * at(rng)}, 1), Status::kOk);
  ASSERT_EQ(map_->Extract({}, 1, submap_.get()), Status::kOk);
  auto in_steps = std::make_unique<Submap>();
  map_->BeginCut({}, 1, in_steps.get());
  for (std::size_t i = 0; i < RollingMap::kCutSteps; ++i) EXPECT_EQ(map_->CutStep(in_steps.get()), Status::kOk);
  ASSERT_EQ(in_steps->points.size(), submap_->points.size());
  for (std::size_t i = 0; i < submap_->points.size(); ++i) EXPECT_EQ(in_steps->points[i].x, submap_->points[i].x);
}

// A wall 20 m ahead that stays, and a car 10 m ahead that is there in the first second and gone in the next two.
TEST_F(RollingMapTest, LeavesOutWhatStoodThereForAWhileOnly) {
  auto scan = std::make_unique<sensor::Scan>();
  auto image = std::make_unique<RangeImage>();
  const std::array<geom::Pose3, RangeImage::kPoses> at_rest{};
  scan->t_end = {100'000'000};
  for (int revolution = 0; revolution < 30; ++revolution) {
    const float car = revolution < 10 ? 10.0F : 1000.0F;
    scan->points.clear();
    for (int column = -100; column <= 100; ++column) {
      for (int beam = -3; beam <= 3; ++beam) {
        const float y_per_x = std::tan(static_cast<float>(column) * 0.0035F);
        const bool hits_car = std::abs(10 * y_per_x) < 1 && beam <= 0;
        const float x = std::min(hits_car ? car : 1000.0F, 20.0F);
        const Eigen::Vector3f p(x, x * y_per_x, x * static_cast<float>(beam) * 0.035F);
        ASSERT_EQ(scan->points.TryPush({p.x(), p.y(), p.z(), 0, 0, 0, 0}), Status::kOk);
        ASSERT_EQ(map_->Insert(p, 0), Status::kOk);
      }
    }
    image->Build(*scan, at_rest);
    map_->Vote(*image, {0, 0, 0}, 0);
  }
  ASSERT_EQ(map_->Extract({}, 0, submap_.get()), Status::kOk);
  int of_wall = 0;
  for (const SubmapPoint& p : submap_->points) {
    EXPECT_GT(p.x, 15) << p.y << " " << p.z;
    of_wall += p.x > 19 ? 1 : 0;
  }
  EXPECT_GT(of_wall, 150);

  auto trusting = std::make_unique<RollingMap>(RollingMapConfig{.max_through_share = 2});
  ASSERT_EQ(trusting->Insert({10, 0, 0}, 0), Status::kOk);
  for (int i = 0; i < 8; ++i) trusting->Vote(*image, {0, 0, 0}, 0);
  ASSERT_EQ(trusting->Extract({}, 0, submap_.get()), Status::kOk);
  EXPECT_EQ(submap_->points.size(), 1U);
}

TEST_F(RollingMapTest, ForgetsTheOldestStretchWhenItIsFull) {
  // Four times the capacity, along a straight path.
  for (int i = 0; i < 1 << 20; ++i) {
    const float along = static_cast<float>(i >> 10);
    ASSERT_EQ(map_->Insert({along, static_cast<float>(i & 31), static_cast<float>((i >> 5) & 31)}, along), Status::kOk);
  }
  EXPECT_GT(map_->evicted(), 0U);
  ASSERT_EQ(map_->Extract({{1023, 0, 0}, geom::Quatd::Identity()}, 1023, submap_.get()), Status::kOk);
  EXPECT_GT(submap_->points.size(), 20000U);  // the recent stretch is whole
}

TEST_F(RollingMapTest, RefusesPointsThatAreNotNumbersOrOutsideTheGrid) {
  EXPECT_EQ(map_->Insert({NAN, 0, 0}, 0), Status::kOutOfRange);
  EXPECT_EQ(map_->Insert({1e9F, 0, 0}, 0), Status::kOutOfRange);
  ASSERT_EQ(map_->Extract({}, 0, submap_.get()), Status::kOk);
  EXPECT_TRUE(submap_->points.empty());
}

}  // namespace
}  // namespace mapweld::submap
