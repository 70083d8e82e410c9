// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/grouping.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace mapweld::merge {
namespace {

using geom::Pose3;
using ::testing::ElementsAre;

// Drives along one street, 20 keyframes each, in frames of their own.
class Fleet {
 public:
  explicit Fleet(int drives) {
    for (int d = 0; d < drives; ++d) {
      Drive drive;
      drive.name = "drive " + std::to_string(d);
      for (int k = 0; k < kKeyframes; ++k) {
        Keyframe keyframe;
        keyframe.odom_T_body = Frame(d).Inverse() * World(k);
        keyframe.path_m = 5.0 * k;
        drive.keyframes.push_back(keyframe);
      }
      drives_.push_back(drive);
    }
  }

  // An overlap that says drive b is `off` metres to the side of where it is.
  void Tie(int a, int b, double off_m = 0, bool accepted = true) {
    Overlap overlap;
    overlap.drive_a = a;
    overlap.drive_b = b;
    overlap.accepted = accepted;
    overlap.test = accepted ? "registration" : "cycle";
    overlap.weight = accepted ? 0.9 : 0;
    overlap.length_m = 60;
    for (int k = 2; k < kKeyframes; k += 3) {
      Loop loop;
      loop.keyframe_a = loop.keyframe_b = k;
      loop.a_T_b.t = {0, off_m, 0};
      overlap.loops.push_back(loop);
    }
    result_.overlaps.push_back(overlap);
  }
  void Solve(int quarantine_after = 3) {
    config_.graph.quarantine_after = quarantine_after;
    ThreadCrew one_by_one(1, nullptr);
    GroupAndSolve(drives_, config_, &one_by_one, &result_);
  }
  bool Recall() { return RecallOverlaps(drives_, config_, &result_); }

  [[nodiscard]] const MergeResult& result() const { return result_; }
  [[nodiscard]] std::string Test(int a, int b) const {
    for (const Overlap& overlap : result_.overlaps) {
      if (overlap.drive_a == a && overlap.drive_b == b) return overlap.accepted ? "accepted" : overlap.test;
    }
    return "none";
  }
  // Distance of the same keyframe of two drives, which should be the same place.
  [[nodiscard]] double Apart(int a, int b) const {
    return (result_.merged_T_body[static_cast<std::size_t>(a)][10].t -
            result_.merged_T_body[static_cast<std::size_t>(b)][10].t)
        .norm();
  }

 private:
  static constexpr int kKeyframes = 20;
  static Pose3 World(int k) { return {{5.0 * k, 0.02 * k * k, 0}, geom::ExpSo3({0, 0, 0.008 * k})}; }
  static Pose3 Frame(int drive) {
    return {{40.0 * drive, -70.0 * drive, 1.0 * drive}, geom::ExpSo3({0, 0, 0.7 * drive})};
  }

  std::vector<Drive> drives_;
  MergeConfig config_;
  MergeResult result_;
};

TEST(Grouping, JoinsDrivesThatOverlapAndLeavesOthersInTheirFrames) {
  Fleet fleet(4);
  fleet.Tie(0, 2);
  fleet.Tie(2, 3);
  fleet.Solve();
  EXPECT_THAT(fleet.result().groups, ElementsAre(ElementsAre(0, 2, 3), ElementsAre(1)));
  EXPECT_LT(fleet.Apart(0, 3), 0.01);
  EXPECT_GT(fleet.Apart(0, 1), 10);
}

TEST(Grouping, SplitsAnOverlapOffThatTheOthersContradict) {
  Fleet fleet(4);
  fleet.Tie(0, 1);
  fleet.Tie(1, 2);
  fleet.Tie(2, 3);
  fleet.Tie(0, 2);
  fleet.Tie(1, 3);
  fleet.Tie(0, 3, 25);
  fleet.Solve();
  EXPECT_EQ(fleet.Test(0, 3), "pose graph");
  EXPECT_EQ(fleet.Test(0, 1), "accepted");
  EXPECT_EQ(fleet.Test(2, 3), "accepted");
  EXPECT_LT(fleet.Apart(0, 3), 0.05);
}

TEST(Grouping, QuarantinesADriveThatDisagreesWithItselfEverywhere) {
  Fleet fleet(7);
  for (int a = 0; a < 5; ++a) {
    for (int b = a + 1; b < 6; ++b) fleet.Tie(a, b);
  }
  for (int a = 0; a < 6; ++a) fleet.Tie(a, 6, 30.0 * (a + 1));
  fleet.Solve(3);
  EXPECT_THAT(fleet.result().groups, ElementsAre(ElementsAre(0, 1, 2, 3, 4, 5), ElementsAre(6)));
  for (int a = 0; a < 6; ++a) EXPECT_EQ(fleet.Test(a, 6), "quarantine") << a;
  EXPECT_LT(fleet.Apart(0, 5), 0.05);
}

TEST(Grouping, DoesNotQuarantineADriveForOneMistakeOfAnother) {
  Fleet fleet(4);
  for (int a = 0; a < 3; ++a) {
    for (int b = a + 1; b < 4; ++b) fleet.Tie(a, b, a == 0 && b == 3 ? 25 : 0);
  }
  fleet.Solve(0);
  EXPECT_EQ(fleet.result().groups.size(), 1U);
}

TEST(Grouping, RecallsAnOverlapThatFitsAfterAll) {
  Fleet fleet(3);
  fleet.Tie(0, 1);
  fleet.Tie(1, 2);
  fleet.Tie(0, 2, 0, false);
  fleet.Solve();
  EXPECT_TRUE(fleet.Recall());
  EXPECT_EQ(fleet.Test(0, 2), "accepted");
  EXPECT_FALSE(fleet.Recall()) << "once";
}

TEST(Grouping, DoesNotRecallWhatStillContradicts) {
  Fleet fleet(3);
  fleet.Tie(0, 1);
  fleet.Tie(1, 2);
  fleet.Tie(0, 2, 8, false);
  fleet.Solve();
  EXPECT_FALSE(fleet.Recall());
  EXPECT_EQ(fleet.Test(0, 2), "cycle");
}

}  // namespace
}  // namespace mapweld::merge
