// SPDX-License-Identifier: Apache-2.0
#include "core/correct/local_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace mapweld::correct {
namespace {

using geom::Pose3;

// A drive along x whose merged frame is turned and shifted against odom.
class LocalCorrectionTest : public testing::Test {
 protected:
  void SetUp() override {
    for (int k = 0; k < 40; ++k) correction_->AddKeyframe(k, OdomPose(k));
  }
  static Pose3 OdomPose(int k) { return {{5.0 * k, 0, 0}, geom::Quatd::Identity()}; }
  static Pose3 MergedFromOdomTruth() { return {{100, -20, 3}, geom::ExpSo3({0, 0, 1.0})}; }
  static MergedPose Merged(int k, int revision, int group = 0) {
    return {k, group, revision, MergedFromOdomTruth() * OdomPose(k), 0.1, 0.01};
  }
  std::unique_ptr<LocalCorrection> correction_ = std::make_unique<LocalCorrection>();
};

TEST_F(LocalCorrectionTest, IsInactiveUntilAMergedPoseArrives) {
  EXPECT_FALSE(correction_->active());
  EXPECT_EQ(correction_->MergedFromOdom({0}).t.norm(), 0);
}

TEST_F(LocalCorrectionTest, FindsTheMergedFrame) {
  for (int k = 10; k < 20; ++k) ASSERT_EQ(correction_->AddMergedPose(Merged(k, 1)), Status::kOk);
  const Pose3 merged_T_odom = correction_->MergedFromOdom({0});
  EXPECT_LT((merged_T_odom.t - MergedFromOdomTruth().t).norm(), 1e-6);
  EXPECT_LT(merged_T_odom.q.angularDistance(MergedFromOdomTruth().q), 1e-7);
}

TEST_F(LocalCorrectionTest, OneWrongMergedPoseAmongManyMovesLittle) {
  for (int k = 10; k < 24; ++k) {
    MergedPose pose = Merged(k, 1);
    if (k == 17) pose.merged_T_body.t.y() += 30;
    ASSERT_EQ(correction_->AddMergedPose(pose), Status::kOk);
  }
  EXPECT_LT((correction_->MergedFromOdom({0}) * OdomPose(23).t - MergedFromOdomTruth() * OdomPose(23).t).norm(), 0.15);
}

TEST_F(LocalCorrectionTest, MovesSmoothlyToANewSolution) {
  for (int k = 10; k < 20; ++k) ASSERT_EQ(correction_->AddMergedPose(Merged(k, 1)), Status::kOk);
  Pose3 last = correction_->MergedFromOdom({0});
  for (int k = 10; k < 20; ++k) {
    MergedPose pose = Merged(k, 2);
    pose.merged_T_body.t.x() += 2.0;
    ASSERT_EQ(correction_->AddMergedPose(pose), Status::kOk);
  }
  for (int i = 1; i <= 50; ++i) {
    const Pose3 now = correction_->MergedFromOdom({i * 100'000'000LL});
    EXPECT_LE((now.t - last.t).norm(), 0.1 + 1e-9);
    last = now;
  }
  EXPECT_NEAR((last.t - MergedFromOdomTruth().t).norm(), 2.0, 1e-6);
}

TEST_F(LocalCorrectionTest, AnotherGroupStartsOver) {
  for (int k = 10; k < 20; ++k) ASSERT_EQ(correction_->AddMergedPose(Merged(k, 1)), Status::kOk);
  (void)correction_->MergedFromOdom({0});
  MergedPose pose = Merged(19, 2, 7);
  pose.merged_T_body.t.x() += 1000;
  ASSERT_EQ(correction_->AddMergedPose(pose), Status::kOk);
  EXPECT_EQ(correction_->group(), 7);
  const Pose3 merged_T_body = correction_->MergedFromOdom({100'000'000}) * OdomPose(19);
  EXPECT_LT((merged_T_body.t - pose.merged_T_body.t).norm(), 1e-6);
}

TEST_F(LocalCorrectionTest, RefusesWhatMakesNoSense) {
  MergedPose pose = Merged(10, 1);
  pose.merged_T_body.t.x() = NAN;
  EXPECT_EQ(correction_->AddMergedPose(pose), Status::kBadInput);
  pose = Merged(10, 1);
  pose.sigma_m = 0;
  EXPECT_EQ(correction_->AddMergedPose(pose), Status::kBadInput);
  EXPECT_EQ(correction_->AddMergedPose(Merged(77, 1)), Status::kOutOfRange);
  ASSERT_EQ(correction_->AddMergedPose(Merged(10, 5)), Status::kOk);
  EXPECT_EQ(correction_->AddMergedPose(Merged(11, 4)), Status::kStale);
}

}  // namespace
}  // namespace mapweld::correct
