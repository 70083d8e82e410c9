// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/registration.hpp"

#include <gtest/gtest.h>

#include "tests/unit/tools/merge/synthetic_town.hpp"
#include "tools/merge/bev_search.hpp"
#include "tools/merge/voxel_mean.hpp"

namespace mapweld::merge {
namespace {

using geom::Pose3;
using geom::Quatd;
using geom::Vec3d;

Pose3 At(double x, double y, double yaw_rad) {
  return {{x, y, 1.8}, Quatd(Eigen::AngleAxisd(yaw_rad, Vec3d::UnitZ()))};
}

SubmapCloud SubmapAt(const SyntheticTown& town, const Pose3& pose, unsigned seed) {
  VoxelMean voxels(0.5);
  for (const Eigen::Vector3f& p : town.Scan(pose, seed, 50)) voxels.Add(p, 1);
  std::vector<WeightedPoint> points;
  voxels.Take(&points);
  SubmapCloud out;
  for (const WeightedPoint& point : points) out.points.push_back(point.p);
  return out;
}

class RegistrationOnAStreet : public ::testing::Test {
 protected:
  RegistrationOnAStreet() : town_(3) { town_.AddStreet({-100, 0}, 300); }
  SyntheticTown town_;
};

TEST_F(RegistrationOnAStreet, RecoversAKnownTransformFromAGuessTwoMetresOff) {
  const Pose3 world_T_a = At(0, 0, 0.2);
  const Pose3 world_T_b = At(7, -2, 2.9);
  const PreparedSubmap a(SubmapAt(town_, world_T_a, 1));
  const PreparedSubmap b(SubmapAt(town_, world_T_b, 2));
  const Pose3 truth = world_T_a.Inverse() * world_T_b;
  Pose3 guess = truth;
  guess.t += Vec3d(1.4, -1.4, 0.5);
  guess.q = guess.q * geom::ExpSo3({0, 0, 0.06});
  const Registration found = Register(a, b, guess, {});
  EXPECT_TRUE(found.converged);
  EXPECT_LT((found.a_T_b.t - truth.t).norm(), 0.2);
  EXPECT_LT(found.a_T_b.q.angularDistance(truth.q), 0.01);
  EXPECT_GT(found.Evidence(), 0.4);
  EXPECT_GT(found.slide_ratio, 0.1);
}

TEST_F(RegistrationOnAStreet, FindsNoEvidenceBetweenDifferentPlaces) {
  SyntheticTown elsewhere(99);
  elsewhere.AddStreet({-100, 0}, 300);
  const PreparedSubmap a(SubmapAt(town_, At(0, 0, 0), 1));
  const PreparedSubmap b(SubmapAt(elsewhere, At(0, 0, 0), 2));
  for (const BevPeak& peak : SearchBev(a, b, 4)) {
    const Pose3 guess{{peak.x_m, peak.y_m, 0}, Quatd(Eigen::AngleAxisd(peak.yaw_rad, Vec3d::UnitZ()))};
    EXPECT_LT(Register(a, b, guess, {}).Evidence(), 0.25);
  }
}

TEST_F(RegistrationOnAStreet, SeesThatABareCorridorCanSlide) {
  SyntheticTown corridor(1);
  corridor.AddBox({0, 0}, {200, 16}, 5);  // two long walls; the short ones are out of sight
  const PreparedSubmap a(SubmapAt(corridor, At(0, 0, 0), 1));
  const Registration found = Register(a, a, {{0.5, 0.3, 0}, Quatd::Identity()}, {});
  EXPECT_LT(found.slide_ratio, 0.1);
  EXPECT_GT(found.Overlap(), 0.9);
  EXPECT_LT(found.Evidence(), 0.05) << "walls that fit everywhere along the corridor are no evidence of the place";
}

TEST_F(RegistrationOnAStreet, SaysSoWhenThereIsNothingToRegister) {
  const PreparedSubmap empty(SubmapCloud{});
  const PreparedSubmap a(SubmapAt(town_, At(0, 0, 0), 1));
  EXPECT_FALSE(Register(a, empty, {}, {}).converged);
  EXPECT_FALSE(Register(empty, a, {}, {}).converged);
  EXPECT_EQ(Register(empty, empty, {}, {}).Evidence(), 0);
}

TEST_F(RegistrationOnAStreet, IgnoresPointsThatAreNotFinite) {
  SubmapCloud cloud = SubmapAt(town_, At(0, 0, 0), 1);
  const std::size_t good = PreparedSubmap(cloud).points().size();
  cloud.points.emplace_back(std::nanf(""), 0.0F, 0.0F);
  cloud.points.emplace_back(0.0F, 1e30F, 0.0F);
  cloud.points.emplace_back(0.0F, 0.0F, std::numeric_limits<float>::infinity());
  EXPECT_EQ(PreparedSubmap(cloud).points().size(), good);
}

TEST_F(RegistrationOnAStreet, FindsThePlaceWithoutAGuess) {
  const Pose3 world_T_a = At(0, 0, 0.2);
  const PreparedSubmap a(SubmapAt(town_, world_T_a, 1));
  for (const double yaw_rad : {0.2, 1.4, -2.0, 3.1}) {
    const Pose3 world_T_b = At(9, 3, yaw_rad);
    const PreparedSubmap b(SubmapAt(town_, world_T_b, 2));
    const Pose3 truth = world_T_a.Inverse() * world_T_b;
    const std::vector<BevPeak> peaks = SearchBev(a, b, 1);
    ASSERT_EQ(peaks.size(), 1U);
    EXPECT_LT(std::hypot(peaks[0].x_m - truth.t.x(), peaks[0].y_m - truth.t.y()), 2.0) << yaw_rad;
    EXPECT_LT(std::abs(std::remainder(peaks[0].yaw_rad - geom::Yaw(truth.q), 6.283185307)), 0.08) << yaw_rad;
  }
}

}  // namespace
}  // namespace mapweld::merge
