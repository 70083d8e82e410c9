// SPDX-License-Identifier: Apache-2.0
#include "core/submap/range_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>

namespace mapweld::submap {
namespace {

// A 16-beam LiDAR 1.9 m above z = 0 turns once in 0.1 s while the vehicle drives along x. What it sees is told by
// `range`, for a ray from `from` along `direction`; 0: nothing.
class RangeImageTest : public testing::Test {
 protected:
  using Range = std::function<float(const Eigen::Vector3f& from, const Eigen::Vector3f& direction)>;

  void Scan(double speed_m_s, const Range& range) {
    std::array<geom::Pose3, RangeImage::kPoses> odom_T_lidar;
    for (std::size_t i = 0; i < odom_T_lidar.size(); ++i) {
      odom_T_lidar[i].t = {speed_m_s * 0.1 * static_cast<double>(i) / (RangeImage::kPoses - 1), 0, 1.9};
    }
    scan_->t_begin = {0};
    scan_->t_end = {100'000'000};
    scan_->points.clear();
    for (int column = 0; column < 1800; ++column) {
      const float azimuth = static_cast<float>(column) * 2 * static_cast<float>(M_PI) / 1800;
      const auto from_x = static_cast<float>(speed_m_s * 0.1 * column / 1800);
      for (int beam = 0; beam < 16; ++beam) {
        const float elevation = static_cast<float>(2 * beam - 15) * static_cast<float>(M_PI) / 180;
        const Eigen::Vector3f direction(std::cos(elevation) * std::cos(azimuth),
                                        std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const float r = range({from_x, 0, 1.9F}, direction);
        const Eigen::Vector3f p = r * direction;
        if (r > 0) (void)scan_->points.TryPush({p.x(), p.y(), p.z(), 0, column * (100'000'000 / 1800), 0, 0});
      }
    }
    image_->Build(*scan_, odom_T_lidar);
  }

  // How often each answer is given for places on the plane x = `x`, ahead, at heights where beams pass.
  std::array<int, 3> LookAhead(float x) {
    std::array<int, 3> answers{};
    for (float y = -3; y <= 3; y += 0.1F) {
      for (float z = 0.7F; z <= 3; z += 0.1F) ++answers[static_cast<std::size_t>(image_->Look({x, y, z}))];
    }
    return answers;
  }

  std::unique_ptr<sensor::Scan> scan_ = std::make_unique<sensor::Scan>();
  std::unique_ptr<RangeImage> image_ = std::make_unique<RangeImage>();
};

float WallAt(float x, const Eigen::Vector3f& from, const Eigen::Vector3f& direction) {
  return direction.x() > 0.1F ? (x - from.x()) / direction.x() : 0;
}

constexpr auto kUnknown = static_cast<std::size_t>(Sight::kUnknown);
constexpr auto kSurface = static_cast<std::size_t>(Sight::kSurface);
constexpr auto kThrough = static_cast<std::size_t>(Sight::kThrough);

TEST_F(RangeImageTest, ThereIsAWallNothingBeforeItAndNoOneKnowsWhatIsBehind) {
  for (const double speed : {0.0, 15.0}) {
    Scan(speed, [](const auto& from, const auto& direction) { return WallAt(20, from, direction); });
    const auto at_wall = LookAhead(20);
    EXPECT_GT(at_wall[kSurface], 300);
    EXPECT_EQ(at_wall[kThrough], 0);
    const auto before = LookAhead(10);
    EXPECT_GT(before[kThrough], 300);
    EXPECT_EQ(before[kSurface], 0);
    const auto behind = LookAhead(30);
    EXPECT_EQ(behind[kSurface] + behind[kThrough], 0);
    EXPECT_GT(behind[kUnknown], 1000);
  }
}

TEST_F(RangeImageTest, TheRoadIsNeverSeenThroughAlthoughBeamsPassLowOverIt) {
  Scan(10, [](const auto& from, const auto& direction) { return direction.z() < 0 ? -from.z() / direction.z() : 0; });
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> at(-40, 40);
  int surface = 0;
  for (int i = 0; i < 20000; ++i) {
    const Sight sight = image_->Look({at(rng), at(rng), 0.03F});
    EXPECT_NE(sight, Sight::kThrough);
    surface += sight == Sight::kSurface ? 1 : 0;
  }
  EXPECT_GT(surface, 500);
}

TEST_F(RangeImageTest, APlaceOnlyHalfAMetreBeforeASurfaceBelongsToIt) {
  Scan(10, [](const auto& from, const auto& direction) { return WallAt(20, from, direction); });
  EXPECT_EQ(LookAhead(19.6F)[kThrough], 0);
}

TEST_F(RangeImageTest, WhatIsNotANumberIsNotSeen) {
  Scan(0, [](const auto&, const auto&) { return NAN; });
  EXPECT_EQ(image_->Look({10, 0, 1}), Sight::kUnknown);
  EXPECT_EQ(image_->Look({0, 0, 1.9F}), Sight::kUnknown);
}

}  // namespace
}  // namespace mapweld::submap
