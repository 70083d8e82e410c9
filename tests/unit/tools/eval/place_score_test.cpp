// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/place_score.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "tests/unit/tools/io/temp_folder.hpp"

namespace mapweld::eval {
namespace {

using ::testing::HasSubstr;

constexpr auto kReverse = static_cast<std::size_t>(Direction::kReverse);
constexpr auto kForward = static_cast<std::size_t>(Direction::kForward);
constexpr auto kCrossing = static_cast<std::size_t>(Direction::kCrossing);

// Keyframes 0 1 2 drive east, 3 4 5 back on the other side: 0 and 5, 1 and 4, 2 and 3 are one place, 4 m apart.
PlaceSet ThereAndBack() {
  PlaceSet set;
  set.AddSession("there", {{0, 0, 0}, {100, 0, 0}, {200, 0, 0}});
  set.AddSession("back", {{200, 4, 0}, {100, 4, 0}, {0, 4, 0}});
  return set;
}

// Symmetric distances, by hand.
float Distance(int i, int j) {
  static const std::map<std::pair<int, int>, float> kTable = {{{0, 3}, 0.9F},  {{0, 4}, 0.5F}, {{0, 5}, 0.1F},
                                                              {{1, 3}, 0.2F},  {{1, 4}, 0.3F}, {{1, 5}, 0.8F},
                                                              {{2, 3}, 0.25F}, {{2, 4}, 0.4F}, {{2, 5}, 0.7F}};
  return kTable.at({std::min(i, j), std::max(i, j)});
}

// Best matches: 0-5 at 0.1 and 5-0 at 0.1 right; 1-3 and 3-1 at 0.2 wrong; 2-3 at 0.25 and 4-1 at 0.3 right.
TEST(PlaceScore, AgreesWithACaseCountedByHand) {
  const PlaceScore score = ScorePlaces(ThereAndBack(), Distance, 1, nullptr);
  const RadiusScore& at = score[1];
  EXPECT_EQ(at.radius_m, 10);
  EXPECT_EQ(at.all.queries, 6);
  EXPECT_DOUBLE_EQ(at.all.at[0], 4.0 / 6);
  EXPECT_DOUBLE_EQ(at.all.at[1], 1);
  ASSERT_EQ(at.curve.size(), 4U);
  EXPECT_DOUBLE_EQ(at.curve[0].precision, 1);
  EXPECT_DOUBLE_EQ(at.curve[0].recall, 2.0 / 6);
  EXPECT_DOUBLE_EQ(at.curve[1].precision, 0.5);
  EXPECT_DOUBLE_EQ(at.curve[1].recall, 2.0 / 6);
  EXPECT_DOUBLE_EQ(at.curve[2].precision, 0.6);
  EXPECT_DOUBLE_EQ(at.curve[3].recall, 4.0 / 6);
  EXPECT_DOUBLE_EQ(at.f1_max, 2.0 / 3);
  EXPECT_DOUBLE_EQ(at.extended_precision, (1 + 2.0 / 6) / 2);
  EXPECT_NEAR(at.auc, 1.0 / 3 + (0.5 + 0.6) / 12 + (0.6 + 2.0 / 3) / 12, 1e-12);
  EXPECT_EQ(at.by_direction[kReverse].queries, 6);
  EXPECT_EQ(at.by_direction[kForward].queries, 0);
}

TEST(PlaceScore, DoesNotDependOnTheNumberOfThreads) {
  const PlaceScore one = ScorePlaces(ThereAndBack(), Distance, 1, nullptr);
  const PlaceScore three = ScorePlaces(ThereAndBack(), Distance, 3, nullptr);
  EXPECT_EQ(one[1].auc, three[1].auc);
  EXPECT_EQ(one[2].all.at, three[2].all.at);
}

TEST(PlaceScore, CountsAKeyframeWithoutDescriptorAsMissed) {
  const auto distance = [](int i, int j) {
    return i == 0 || j == 0 ? std::numeric_limits<float>::infinity() : Distance(i, j);
  };
  const RadiusScore at = ScorePlaces(ThereAndBack(), distance, 1, nullptr)[1];
  EXPECT_EQ(at.all.queries, 6);
  EXPECT_DOUBLE_EQ(at.all.at[0], 2.0 / 6);  // 0 and 5 have lost one another
  EXPECT_DOUBLE_EQ(at.all.at[3], 4.0 / 6);  // at any rank
  EXPECT_DOUBLE_EQ(at.curve.back().recall, 2.0 / 6);
}

TEST(PlaceScore, AsksInOneSessionOnlyForWhatLiesSixtyMetresOfPathBack) {
  PlaceSet set;  // a square of 40 m, one and a quarter times around
  std::vector<geom::Vec3d> positions;
  for (int i = 0; i <= 20; ++i) {
    const double along_m = 10.0 * (i % 4);
    const int side = i / 4 % 4;
    const std::array<geom::Vec3d, 4> corner = {geom::Vec3d{along_m, 0, 0}, geom::Vec3d{40, along_m, 0},
                                               geom::Vec3d{40 - along_m, 40, 0}, geom::Vec3d{0, 40 - along_m, 0}};
    positions.push_back(corner[static_cast<std::size_t>(side)]);
  }
  set.AddSession("square", positions);
  EXPECT_FALSE(set.IsCandidate(5, 0));
  EXPECT_TRUE(set.IsCandidate(6, 0));
  EXPECT_FALSE(set.IsCandidate(0, 6));
  const RadiusScore at = ScorePlaces(
      set, [](int i, int j) { return static_cast<float>(i - j); }, 1, nullptr)[0];
  EXPECT_EQ(at.all.queries, 5);  // the last five keyframes are where the first were
}

// East along a street that another drive has gone east and a third one crosses.
TEST(PlaceScore, JudgesCrossingsWithoutTheKeyframesThatPassedInTheSameDirection) {
  PlaceSet set;
  set.AddSession("query", {{-5, 0, 0}, {0, 0, 0}, {5, 0, 0}});                     // 0 1 2
  set.AddSession("same street", {{-12, 1, 0}, {0, 1, 0}, {12, 1, 0}});             // 3 4 5
  set.AddSession("crossing", {{0, -8, 0}, {0, 0, 0}, {0, 8, 0}});                  // 6 7 8
  const auto distance = [](int, int j) { return static_cast<float>(j) * 0.01F; };  // the same street looks nearest
  const RadiusScore at = ScorePlaces(set, distance, 1, nullptr)[1];
  // Queries 0, 1, 2 find 6; queries 3, 4, 5 find a hit among 6, 7, 8 only when theirs is first; 6, 7, 8 find 0.
  EXPECT_EQ(at.by_direction[kCrossing].queries, 7);  // 3 and 5 are more than 10 m from the crossing drive
  EXPECT_DOUBLE_EQ(at.by_direction[kCrossing].at[0], 1);
}

TEST(PlaceScore, SaysThatAnEmptySetHasNothingToRecognise) {
  PlaceSet set;
  EXPECT_THAT(test::ErrorOf([&] {
                set.AddSession("short", {{0, 0, 0}, {5, 0, 0}});
              }),
              HasSubstr("short has 2 keyframes"));
  set.AddSession("straight", {{0, 0, 0}, {5, 0, 0}, {10, 0, 0}});
  const RadiusScore at = ScorePlaces(
      set, [](int, int) { return 0.0F; }, 1, nullptr)[1];
  EXPECT_EQ(at.all.queries, 0);
  EXPECT_EQ(at.f1_max, 0);
  EXPECT_TRUE(at.curve.empty());
}

}  // namespace
}  // namespace mapweld::eval
