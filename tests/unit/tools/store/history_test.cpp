// SPDX-License-Identifier: Apache-2.0
#include "tools/store/history.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_city.hpp"
#include "tests/support/temporary_directory.hpp"
#include "tools/store/explain.hpp"

namespace mapweld::store {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

class Histories : public testing::Test {
 protected:
  Histories() {
    for (int d = 0; d < 3; ++d) {
      DriveInfo info;
      info.name = std::string(1, static_cast<char>('a' + d));
      const DriveKey key = city_.AddDrive(info);
      for (int k = 0; k < 3; ++k) city_.AddKeyframe(key, k, test::SmallKeyframe(d, k));
    }
  }
  // The first n drives in these groups, with these overlaps accepted; poses moved to show which merge they are of.
  static MergeRecord State(int n, std::vector<std::vector<std::int32_t>> groups,
                           const std::vector<std::pair<int, int>>& accepted, double x) {
    MergeRecord record;
    record.cause = "merge";
    for (int d = 0; d < n; ++d) {
      record.drives.emplace_back(1, static_cast<char>('a' + d));
      record.keyframes.push_back(3);
      record.merged_T_body.emplace_back(3);
      for (geom::Pose3& pose : record.merged_T_body.back()) pose.t.x() = x;
    }
    record.groups = std::move(groups);
    for (const auto& [a, b] : accepted) {
      record.overlaps.emplace_back();
      record.overlaps.back().drive_a = a;
      record.overlaps.back().drive_b = b;
      record.overlaps.back().accepted = true;
      record.overlaps.back().test = "registration";
      record.overlaps.back().loops.push_back({1, 2, {}, 0.75, 0.12, 1.0});
    }
    return record;
  }
  const test::TemporaryDirectory directory_;
  CityStore city_{directory_.File("city.db")};
};

TEST_F(Histories, RecordAStateOnce) {
  const MergeRecord state = State(2, {{0, 1}}, {{0, 1}}, 1);
  EXPECT_EQ(RecordMerge(&city_, state), 1);
  MergeRecord later = state;
  later.when = "later";
  EXPECT_EQ(RecordMerge(&city_, later), 1) << "nothing is new but the time";
  EXPECT_EQ(RecordMerge(&city_, State(2, {{0, 1}}, {{0, 1}}, 2)), 2);
  EXPECT_EQ(Merges(&city_).size(), 2U);
}

TEST_F(Histories, TellWhatJoinedAndWhatSplit) {
  const MergeRecord two = State(2, {{0}, {1}}, {}, 0);
  const MergeRecord joined = State(3, {{0, 1, 2}}, {{0, 1}, {1, 2}}, 0);
  const MergeRecord split = State(3, {{0, 1}, {2}}, {{0, 1}}, 0);
  EXPECT_THAT(Changes(nullptr, two), ElementsAre("a came", "b came"));
  EXPECT_THAT(Changes(&two, joined), ElementsAre("c came", "a + b + c joined"));
  EXPECT_THAT(Changes(&joined, split), ElementsAre("a + b + c split"));
  EXPECT_THAT(Changes(&split, joined), ElementsAre("a + b + c joined"));
  EXPECT_THAT(Changes(&joined, joined), IsEmpty());
  EXPECT_THAT(Changes(&joined, two), ElementsAre("c was set aside", "a + b split"));
}

TEST_F(Histories, UndoTakesBackWhatTheLastMergeJoinedAndNothingElse) {
  RecordMerge(&city_, State(2, {{0, 1}}, {{0, 1}}, 1));
  RecordMerge(&city_, State(3, {{0, 1, 2}}, {{0, 1}, {1, 2}}, 2));
  EXPECT_THAT(Undo(&city_, "now"), ElementsAre(Pair("b", "c")));
  const auto last = LastMerge(&city_);
  ASSERT_TRUE(last.has_value());
  EXPECT_EQ(last->number, 3);
  EXPECT_EQ(last->record.cause, "undo of 2");
  EXPECT_THAT(last->record.groups, ElementsAre(ElementsAre(0, 1), ElementsAre(2)));
  EXPECT_EQ(last->record.merged_T_body[0][1].t.x(), 1) << "the poses of before";
  EXPECT_EQ(last->record.merged_T_body[2][1].t.x(), 5) << "alone, in its own odometry";
  EXPECT_TRUE(last->record.overlaps[0].accepted);
  EXPECT_FALSE(last->record.overlaps[1].accepted);
  EXPECT_EQ(last->record.overlaps[1].test, kByHand);
  ASSERT_EQ(Rulings(&city_).size(), 1U);
  EXPECT_THROW(Undo(&city_, "now"), StoreError) << "the undo joined nothing";
}

TEST_F(Histories, RulingsNeedDrivesThatExistAndCanBeTakenBack) {
  const Ruling ruling{Ruling::Kind::kRefusePair, "a", "b", "now"};
  AddRuling(&city_, ruling);
  AddRuling(&city_, ruling);
  EXPECT_EQ(Rulings(&city_).size(), 1U);
  EXPECT_TRUE(RemoveRuling(&city_, ruling));
  EXPECT_FALSE(RemoveRuling(&city_, ruling));
  try {
    AddRuling(&city_, {Ruling::Kind::kQuarantine, "z", "", "now"});
    FAIL();
  } catch (const StoreError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no drive called 'z'; it holds a, b, c"));
  }
}

TEST_F(Histories, ExplainSaysWhichTestDecidedAndTheNumbers) {
  MergeRecord state = State(3, {{0, 1}, {2}}, {{0, 1}, {1, 2}}, 1);
  state.overlaps[1].accepted = false;
  state.overlaps[1].test = "cycle";
  RecordMerge(&city_, state);
  EXPECT_THAT(Explain(&city_, "b", "a"),
              AllOf(HasSubstr("a = a, b = b"), HasSubstr("overlap accepted, both in group 1"),
                    HasSubstr("registration"), HasSubstr("0.75        0.120")));
  EXPECT_THAT(Explain(&city_, "b", "c"), AllOf(HasSubstr("overlap refused, in groups 1 and 2"), HasSubstr("cycle")));
  EXPECT_THAT(Explain(&city_, "a", "c"), AllOf(HasSubstr("no overlap"), HasSubstr("descriptor distance")));
  EXPECT_THROW(Explain(&city_, "a", "nobody"), StoreError);
}

}  // namespace
}  // namespace mapweld::store
