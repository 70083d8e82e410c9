// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/merge_score.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/unit/tools/io/temp_folder.hpp"

namespace mapweld::eval {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Two zones: a b c, where b and c only cross; d alone.
MergeTruth Truth() {
  return {{"a", "b", "c", "d"}, {{{"a", "b"}, 100.0}, {{"a", "c"}, 40.0}}, {{"b", "c"}}};
}

TEST(MergeScore, CountsWhatWasFoundMissedAndWrong) {
  MergeOutcome outcome;
  outcome.accepted = {{"a", "b"}, {"a", "d"}, {"b", "c"}};
  outcome.refused = {{{"a", "c"}, "overlap ratio"}};
  outcome.groups = {{"a", "b", "d"}, {"c"}};
  const MergeScore score = ScoreMerge(Truth(), outcome);
  EXPECT_EQ(score.found, 1);
  EXPECT_EQ(score.crossings_found, 1);
  EXPECT_THAT(score.wrong, ElementsAre(NamePair{"a", "d"}));
  EXPECT_NEAR(score.Precision(), 2.0 / 3, 1e-12);
  EXPECT_NEAR(score.Recall(), 0.5, 1e-12);
  ASSERT_EQ(score.missed.size(), 1U);
  EXPECT_EQ(score.missed[0].test, "overlap ratio");
  EXPECT_EQ(score.zones, 2);
  EXPECT_EQ(score.impure_groups, 1);
  EXPECT_THAT(ScoreTable(score), HasSubstr("missed: a c, 40 m together: overlap ratio"));
}

TEST(MergeScore, IsPerfectForAPerfectMergeAndForNothingToMerge) {
  const MergeScore perfect = ScoreMerge(Truth(), {{{"a", "b"}, {"a", "c"}}, {}, {{"a", "b", "c"}, {"d"}}});
  EXPECT_EQ(perfect.Precision(), 1);
  EXPECT_EQ(perfect.Recall(), 1);
  EXPECT_EQ(perfect.impure_groups, 0);
  const MergeScore nothing = ScoreMerge({{"a"}, {}, {}}, {{}, {}, {{"a"}}});
  EXPECT_EQ(nothing.Precision(), 1);
  EXPECT_EQ(nothing.Recall(), 1);
}

TEST(MergeScore, CountsOnlyDrivesThatWereMerged) {
  MergeTruth truth;
  truth.names = {"a", "b", "c", "d"};
  truth.overlaps = {{{"a", "b"}, 100}, {{"b", "c"}, 80}, {{"c", "d"}, 60}};
  MergeOutcome outcome;
  outcome.accepted = {{"a", "b"}};
  outcome.groups = {{"a", "b"}};
  const MergeScore score = ScoreMerge(truth, outcome);
  EXPECT_EQ(score.not_merged, 2);
  EXPECT_EQ(score.true_overlaps, 1);
  EXPECT_EQ(score.Recall(), 1);
  EXPECT_EQ(score.zones, 1);
  EXPECT_THAT(ScoreTable(score), ::testing::HasSubstr("2 drives of the scenario are in no group"));
}

TEST(MergeScore, TellsOnlyTheLongestOfManyMissedOverlaps) {
  MergeTruth truth;
  MergeOutcome outcome;
  for (char name = 'a'; name <= 'z'; ++name) {
    truth.names.insert({name});
    outcome.groups.push_back({{name}});
    if (name > 'a') truth.overlaps[{"a", {name}}] = name;
  }
  const std::string table = ScoreTable(ScoreMerge(truth, outcome));
  EXPECT_THAT(table, ::testing::HasSubstr("missed: a z, 122 m together"));
  EXPECT_THAT(table, ::testing::HasSubstr("... and 5 more"));
}

TEST(MergeScore, ReadsWhatTheSimulatorAndTheMergeWrite) {
  const test::TempFolder folder;
  const auto truth = folder.Put("scenario.json", R"({"vehicles": [{"id": 1}, {"id": 2}], "overlaps_of_whole_routes": [
    {"vehicles": [2, 1], "kind": "overlap", "same_direction_m": 10.0, "opposite_direction_m": 50.0},
    {"vehicles": [1, 3], "kind": "overlap", "same_direction_m": 99.0, "opposite_direction_m": 0.0}]})");
  (void)folder.Put("overlaps.json",
                   R"({"overlaps": [{"pair": ["agent_1", "agent_2"], "verdict": "accepted", "test": ""}]})");
  (void)folder.Put("groups.json", R"({"groups": [{"recordings": ["agent_1", "agent_2"]}]})");
  const MergeScore score = ScoreMerge(ReadMergeTruth(truth), ReadMergeOutcome(truth.parent_path()));
  EXPECT_EQ(score.true_overlaps, 1) << "vehicle 3 was not simulated";
  EXPECT_EQ(score.found, 1);
}

TEST(MergeScore, NamesTheFileThatIsWrong) {
  const test::TempFolder folder;
  const auto truth = folder.Put("scenario.json", R"({"vehicles": 7})");
  try {
    (void)ReadMergeTruth(truth);
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("scenario.json"));
  }
  EXPECT_THROW((void)ReadMergeOutcome(folder.Put("x", "").parent_path()), std::runtime_error);
}

}  // namespace
}  // namespace mapweld::eval
