// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/trajectory_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/io/temp_folder.hpp"

namespace mapweld::eval {
namespace {

using ::testing::HasSubstr;

std::vector<io::StampedPose> Path(const std::vector<geom::Vec3d>& positions, std::int64_t first_ns = 0) {
  std::vector<io::StampedPose> path;
  for (const geom::Vec3d& p : positions) {
    path.push_back({{first_ns + static_cast<std::int64_t>(path.size()) * 100'000'000}, {p, geom::Quatd::Identity()}});
  }
  return path;
}

std::vector<io::StampedPose> Moved(std::vector<io::StampedPose> path, const geom::Pose3& a_T_b) {
  for (io::StampedPose& pose : path) pose.world_T_body = a_T_b * pose.world_T_body;
  return path;
}

const std::vector<geom::Vec3d> kSquare = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
const geom::Pose3 kAnywhere = {{100, -20, 3}, geom::ExpSo3({0.4, -0.3, 2.5})};

TEST(Statistics, OfThreeFourAndZero) {
  const ErrorStatistics s = Statistics({4, 0, 3});
  EXPECT_EQ(s.count, 3U);
  EXPECT_DOUBLE_EQ(s.mean_m, 7.0 / 3);
  EXPECT_DOUBLE_EQ(s.rmse_m, std::sqrt(25.0 / 3));
  EXPECT_EQ(s.median_m, 3);
  EXPECT_EQ(s.max_m, 4);
  EXPECT_EQ(Statistics({1, 4, 2, 3}).median_m, 2.5);
  EXPECT_EQ(Statistics({}).rmse_m, 0);
}

TEST(Alignment, RecoversAnyRigidMotion) {
  const auto truth = Path({{0, 0, 0}, {10, 0, 1}, {10, 10, 2}, {0, 10, -3}});
  const GroupError error = EvaluateGroup({{"a", truth, Moved(truth, kAnywhere)}});
  EXPECT_NEAR(error.all.max_m, 0, 1e-9);
  EXPECT_LT(geom::LocalCoordinates(error.truth_T_estimate * kAnywhere, {}).norm(), 1e-9);
}

TEST(Alignment, NeverMirrors) {
  std::vector<geom::Vec3d> shape = {{0, 0, 0}, {10, 0, 0}, {0, 5, 0}, {0, 0, 2}};
  const auto truth = Path(shape);
  for (geom::Vec3d& p : shape) p.y() = -p.y();
  const GroupError error = EvaluateGroup({{"a", truth, Path(shape)}});
  EXPECT_NEAR(error.truth_T_estimate.q.toRotationMatrix().determinant(), 1, 1e-9);
  EXPECT_GT(error.all.rmse_m, 0.1) << "only a mirror image would fit";
}

TEST(Alignment, DoesNotScale) {
  std::vector<geom::Vec3d> doubled = kSquare;
  for (geom::Vec3d& p : doubled) p *= 2;
  const GroupError error = EvaluateGroup({{"a", Path(kSquare), Moved(Path(doubled), kAnywhere)}});
  // Each corner of the true square is 5 sqrt(2) from the centre, of the estimated one twice as far.
  EXPECT_NEAR(error.all.rmse_m, 5 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(error.all.max_m, 5 * std::sqrt(2.0), 1e-9);
}

TEST(Alignment, FitsAStraightRoadAndASinglePose) {
  const auto road = Path({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {7, 0, 0}});
  EXPECT_NEAR(EvaluateGroup({{"a", road, Moved(road, kAnywhere)}}).all.max_m, 0, 1e-9);
  const auto stop = Path({{1, 2, 3}});
  EXPECT_NEAR(EvaluateGroup({{"a", stop, Moved(stop, kAnywhere)}}).all.max_m, 0, 1e-9);
}

TEST(Alignment, OfHandComputedErrors) {
  // Opposite corners raised, the others lowered by 1 m: no rigid motion of the plane helps, each corner is 1 m off.
  auto estimate = Path({{0, 0, 1}, {10, 0, -1}, {10, 10, 1}, {0, 10, -1}});
  const GroupError error = EvaluateGroup({{"a", Path(kSquare), Moved(estimate, kAnywhere)}});
  EXPECT_NEAR(error.all.rmse_m, 1, 1e-9);
  EXPECT_NEAR(error.all.median_m, 1, 1e-9);
  ASSERT_EQ(error.vehicles[0].errors_m.size(), 4U);
}

TEST(GroupError, CountsVehiclesThatAreWronglyPlacedToOneAnother) {
  // Two perfect vehicles, the second one 2 m too high in the common frame: each is 1 m off after the best alignment.
  const auto a = Path(kSquare);
  const auto b = Path(kSquare, 1'000'000'000'000);
  const geom::Pose3 raised = {{0, 0, 2}, geom::Quatd::Identity()};
  const GroupError error = EvaluateGroup({{"a", a, Moved(a, kAnywhere)}, {"b", b, Moved(b, kAnywhere * raised)}});
  EXPECT_NEAR(error.all.rmse_m, 1, 1e-9);
  EXPECT_NEAR(error.vehicles[0].together.rmse_m, 1, 1e-9);
  EXPECT_NEAR(error.vehicles[1].together.max_m, 1, 1e-9);
  EXPECT_NEAR(error.vehicles[0].alone.rmse_m, 0, 1e-9);
  EXPECT_NEAR(error.vehicles[1].alone.rmse_m, 0, 1e-9);
}

TEST(GroupError, WeighsVehiclesByTheirPoses) {
  std::vector<geom::Vec3d> long_path;
  for (int i = 0; i < 5; ++i) long_path.insert(long_path.end(), kSquare.begin(), kSquare.end());
  const geom::Pose3 raised = {{0, 0, 6}, geom::Quatd::Identity()};
  const GroupError error =
      EvaluateGroup({{"a", Path(long_path), Path(long_path)}, {"b", Path(kSquare), Moved(Path(kSquare), raised)}});
  EXPECT_NEAR(error.vehicles[0].together.rmse_m, 1, 1e-9);  // 20 poses pull five times as hard as 4
  EXPECT_NEAR(error.vehicles[1].together.rmse_m, 5, 1e-9);
  EXPECT_EQ(error.all.count, 24U);
  EXPECT_NEAR(error.all.mean_m, (20.0 * 1 + 4 * 5) / 24, 1e-9);
}

TEST(Truth, IsInterpolatedBetweenItsPoses) {
  std::vector<io::StampedPose> truth = Path({{0, 0, 0}, {1, 0, 0}});
  truth[1].world_T_body.q = geom::ExpSo3({0, 0, 1});
  geom::Pose3 pose;
  ASSERT_TRUE(TruthAt(truth, {25'000'000}, &pose));
  EXPECT_NEAR(pose.t.x(), 0.25, 1e-12);
  EXPECT_NEAR(geom::Yaw(pose.q), 0.25, 1e-12);
  ASSERT_TRUE(TruthAt(truth, {100'000'000}, &pose));
  EXPECT_EQ(pose.t.x(), 1);
}

TEST(Truth, EndsAtItsEndsAndInGaps) {
  std::vector<io::StampedPose> truth = Path({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  truth[2].t = {5'000'000'000};
  geom::Pose3 pose;
  EXPECT_TRUE(TruthAt(truth, {-9'000'000}, &pose));
  EXPECT_FALSE(TruthAt(truth, {-11'000'000}, &pose));
  EXPECT_TRUE(TruthAt(truth, {5'009'000'000}, &pose));
  EXPECT_FALSE(TruthAt(truth, {5'011'000'000}, &pose));
  EXPECT_FALSE(TruthAt(truth, {2'000'000'000}, &pose)) << "nobody knows where it was in those five seconds";
  EXPECT_FALSE(TruthAt({}, {0}, &pose));
}

TEST(GroupError, LeavesOutPosesWithoutTruthAndCountsThem) {
  auto estimate = Path(kSquare);
  estimate.push_back({{60'000'000'000}, {{999, 999, 999}, geom::Quatd::Identity()}});
  const GroupError error = EvaluateGroup({{"a", Path(kSquare), estimate}});
  EXPECT_NEAR(error.all.max_m, 0, 1e-9);
  EXPECT_EQ(error.vehicles[0].unmatched, 1U);
}

TEST(GroupError, RefusesAVehicleWhoseClockIsAnother) {
  const auto action = [] { (void)EvaluateGroup({{"car_7", Path(kSquare), Path(kSquare, 1'000'000'000'000)}}); };
  EXPECT_THAT(test::ErrorOf(action), HasSubstr("car_7: no estimated pose has truth at its time"));
}

}  // namespace
}  // namespace mapweld::eval
