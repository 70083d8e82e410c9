// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/overlap_truth.hpp"

#include <gtest/gtest.h>

namespace mapweld::sim {
namespace {

LanePath Straight(const Vec2d& from, const Vec2d& to) {
  return LanePath::Beside({from, (from + to) / 2, to});
}

TEST(TrueOverlaps, TellDirectionsApart) {
  const auto found = FindTrueOverlaps({
      Straight({0, 0}, {200, 0}),
      Straight({50, 0}, {250, 0}),
      Straight({150, 0}, {-100, 0}),
  });
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(std::pair(found[0].a, found[0].b), std::pair(0, 1));
  EXPECT_NEAR(found[0].same_direction_m, 160, 4);  // 150 m of street, and 10 m before the other begins
  EXPECT_EQ(found[0].opposite_direction_m, 0);
  EXPECT_EQ(std::pair(found[1].a, found[1].b), std::pair(0, 2));
  EXPECT_NEAR(found[1].opposite_direction_m, 159, 4);
  EXPECT_EQ(found[1].same_direction_m, 0);
}

TEST(TrueOverlaps, CountACrossingAsSuch) {
  const auto found = FindTrueOverlaps({Straight({-100, 0}, {100, 0}), Straight({0, -100}, {0, 100})});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].Shared(), 0);
  EXPECT_NEAR(found[0].crossing_m, 21, 2);
}

TEST(TrueOverlaps, LeaveOutDrivesThatNeverMeet) {
  EXPECT_TRUE(FindTrueOverlaps({Straight({0, 0}, {100, 0}), Straight({0, 40}, {100, 40})}).empty());
  EXPECT_TRUE(FindTrueOverlaps({}).empty());
}

}  // namespace
}  // namespace mapweld::sim
