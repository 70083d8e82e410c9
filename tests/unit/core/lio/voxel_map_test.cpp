// SPDX-License-Identifier: Apache-2.0
#include "core/lio/voxel_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

namespace mapweld::lio {
namespace {

class VoxelMapTest : public testing::Test {
 protected:
  // A plane through z = 0.3 with 1 cm of noise.
  void AddFloor(int n, float size) {
    std::uniform_real_distribution<float> at(0, size);
    std::normal_distribution<float> noise(0, 0.01F);
    for (int i = 0; i < n; ++i) ASSERT_EQ(map_->Insert({at(rng_), at(rng_), 0.3F + noise(rng_)}), Status::kOk);
  }
  std::unique_ptr<VoxelMap> map_ = std::make_unique<VoxelMap>();
  std::mt19937 rng_{1};
  Plane plane_;
};

TEST_F(VoxelMapTest, FindsTheFloorThroughNoise) {
  AddFloor(2000, 5);
  ASSERT_TRUE(map_->FindPlane({2.5F, 2.5F, 0.5F}, &plane_));
  EXPECT_GT(std::abs(plane_.normal.z()), 0.999F);
  EXPECT_NEAR(plane_.mean.z(), 0.3F, 0.01F);
  EXPECT_NEAR(std::sqrt(plane_.variance), 0.01F, 0.003F);
}

TEST_F(VoxelMapTest, LooksIntoTheNeighbouringVoxel) {
  AddFloor(2000, 5);
  EXPECT_TRUE(map_->FindPlane({2.5F, 2.5F, 1.05F}, &plane_));  // one voxel up
  EXPECT_FALSE(map_->FindPlane({2.5F, 2.5F, 2.5F}, &plane_));  // two voxels up
}

TEST_F(VoxelMapTest, ASingleLineOfPointsIsNotAPlane) {
  for (int i = 0; i < 100; ++i) ASSERT_EQ(map_->Insert({0.009F * static_cast<float>(i), 0.5F, 0.5F}), Status::kOk);
  EXPECT_FALSE(map_->FindPlane({0.5F, 0.5F, 0.5F}, &plane_));
}

TEST_F(VoxelMapTest, ABlobIsNotAPlane) {
  std::uniform_real_distribution<float> at(0, 1);
  for (int i = 0; i < 300; ++i) ASSERT_EQ(map_->Insert({at(rng_), at(rng_), at(rng_)}), Status::kOk);
  EXPECT_FALSE(map_->FindPlane({0.5F, 0.5F, 0.5F}, &plane_));
}

TEST_F(VoxelMapTest, AMatureVoxelNoLongerMoves) {
  AddFloor(5000, 1);
  ASSERT_TRUE(map_->FindPlane({0.5F, 0.5F, 0.3F}, &plane_));
  const float before = plane_.mean.z();
  for (int i = 0; i < 5000; ++i) {
    ASSERT_EQ(map_->Insert({0.001F * static_cast<float>(i % 1000), 0.5F, 0.9F}), Status::kOk);
  }
  ASSERT_TRUE(map_->FindPlane({0.5F, 0.5F, 0.3F}, &plane_));
  EXPECT_EQ(plane_.mean.z(), before);
}

TEST_F(VoxelMapTest, EvictsTheVoxelsOfTheOldestScansWhenFull) {
  // A wall that grows along x, six times the capacity: no bucket stays less than full of later voxels.
  for (int x = 0; x < 6000; ++x) {
    map_->BeginScan();
    for (int cell = 0; cell < 64; ++cell) {
      for (int i = 0; i < 12; ++i) {
        const auto fx = static_cast<float>(x);
        const float u = static_cast<float>(i % 4) / 4.0F;
        const float v = static_cast<float>(i / 4) / 3.0F;
        ASSERT_EQ(map_->Insert({fx + u, static_cast<float>(cell) + v, 0.5F}), Status::kOk);
      }
    }
  }
  EXPECT_GT(map_->evicted(), 0U);
  int recent = 0;
  int old = 0;
  for (int cell = 0; cell < 64; ++cell) {
    recent += map_->FindPlane({5990.5F, static_cast<float>(cell) + 0.5F, 0.5F}, &plane_) ? 1 : 0;
    old += map_->FindPlane({10.5F, static_cast<float>(cell) + 0.5F, 0.5F}, &plane_) ? 1 : 0;
  }
  EXPECT_EQ(recent, 64);
  EXPECT_EQ(old, 0);
}

TEST_F(VoxelMapTest, RefusesWhatIsNotAPlaceInTheGrid) {
  EXPECT_EQ(map_->Insert({NAN, 0, 0}), Status::kOutOfRange);
  EXPECT_EQ(map_->Insert({0, 1e20F, 0}), Status::kOutOfRange);
  EXPECT_FALSE(map_->FindPlane({0, 0, INFINITY}, &plane_));
}

}  // namespace
}  // namespace mapweld::lio
