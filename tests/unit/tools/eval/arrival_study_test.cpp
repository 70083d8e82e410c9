// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/arrival_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/io/temp_folder.hpp"
#include "tools/merge/overlap_weight.hpp"

namespace mapweld::eval {
namespace {

using ::testing::HasSubstr;

// 0-1-2 in a chain, 3 alone.
MergedDrives Chain() {
  return {{"a", "b", "c", "d"}, {{0, 1, 500, 0.99}, {1, 2, 400, 0.98}}};
}

TEST(ArrivalStudy, EndsWithTheSameGroupsInEveryOrder) {
  const ArrivalStudy study = StudyArrivals(Chain(), {0, 0, 0, 1}, 10, 50, 1);
  ASSERT_EQ(study.steps.size(), 4U);
  EXPECT_EQ(study.outcomes, 1);
  EXPECT_EQ(study.steps[3].fewest_groups, 2);
  EXPECT_EQ(study.steps[3].most_groups, 2);
  EXPECT_DOUBLE_EQ(study.steps[0].mean_groups, 1);
  EXPECT_EQ(study.steps[3].mixed_groups, 0);
}

// Two of four drives: a-b and b-c are one group, the other four pairs are two.
TEST(ArrivalStudy, CountsOverTheOrders) {
  const ArrivalStudy study = StudyArrivals(Chain(), {}, 10, 3000, 1);
  EXPECT_EQ(study.steps[1].fewest_groups, 1);
  EXPECT_EQ(study.steps[1].most_groups, 2);
  EXPECT_NEAR(study.steps[1].mean_groups, (2 * 1 + 4 * 2) / 6.0, 0.03);
}

TEST(ArrivalStudy, SeesAGroupOfTwoZones) {
  EXPECT_EQ(StudyArrivals(Chain(), {0, 0, 1, 1}, 10, 10, 1).steps[3].mixed_groups, 10);
}

TEST(ArrivalStudy, WeighsAnewAsTheMergeWould) {
  merge::WeightConfig ten;
  merge::WeightConfig thirty;
  thirty.half_weight_overlap_m = 30;
  const WeighedOverlap overlap{0, 1, 80, merge::OverlapWeight(0.3, 80, ten)};
  EXPECT_NEAR(Reweighed(overlap, ten.half_weight_overlap_m, 30), merge::OverlapWeight(0.3, 80, thirty), 1e-12);
}

TEST(ArrivalStudy, NamesTheFileThatIsMissingOrBroken) {
  const test::TempFolder folder;
  EXPECT_THAT(test::ErrorOf([&] { ReadMergedDrives(folder.path()); }), HasSubstr("groups.json"));
  folder.Put("groups.json", R"({"groups": [{"recordings": ["a"]}]})");
  folder.Put("overlaps.json",
             R"({"overlaps": [{"pair": ["a", "x"], "verdict": "accepted", "length_m": 1, "weight": 1}]})");
  EXPECT_THAT(test::ErrorOf([&] { ReadMergedDrives(folder.path()); }), HasSubstr("'x' is in no group"));
  folder.Put("overlaps.json", "{");
  EXPECT_THAT(test::ErrorOf([&] { ReadMergedDrives(folder.path()); }), HasSubstr("overlaps.json"));
}

}  // namespace
}  // namespace mapweld::eval
