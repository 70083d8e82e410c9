// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace mapweld::merge {
namespace {

using geom::Pose3;
using geom::Quatd;
using geom::Vec3d;

Quatd Turn(double yaw_rad) {
  return Quatd(Eigen::AngleAxisd(yaw_rad, Vec3d::UnitZ()));
}

// The same keyframes seen in two odometries.
std::vector<PlacedMatch> SamePlaces(const Pose3& a_T_b, const std::vector<Pose3>& in_b) {
  std::vector<PlacedMatch> out;
  for (const Pose3& pose : in_b) out.push_back({{}, a_T_b * pose, pose, 0.0});
  return out;
}

TEST(Alignment, IsExactForMatchesWithoutError) {
  const Pose3 a_T_b{{120, -40, 7}, Turn(2.1)};
  const auto matches = SamePlaces(a_T_b, {{{0, 0, 0}, Turn(0.1)}, {{30, 5, 1}, Turn(0.7)}, {{60, 40, 2}, Turn(1.5)}});
  const Alignment alignment = Align(matches, {});
  EXPECT_LT((alignment.a_T_b.t - a_T_b.t).norm(), 1e-9);
  EXPECT_LT(alignment.a_T_b.q.angularDistance(a_T_b.q), 1e-9);
  EXPECT_LT(alignment.rms_m, 1e-9);
}

TEST(Alignment, UsesTheYawOfAMatchWhereAllMatchesAreOnOneSpot) {
  const Pose3 a_T_b{{10, 20, 0}, Turn(-1.2)};
  const Alignment alignment = Align(SamePlaces(a_T_b, {{{5, 5, 0}, Turn(0.4)}}), {});
  EXPECT_LT(alignment.a_T_b.q.angularDistance(a_T_b.q), 1e-9);
  EXPECT_LT((alignment.a_T_b.t - a_T_b.t).norm(), 1e-9);
}

TEST(Alignment, TrustsPositionsMoreTheFurtherApartTheyAre) {
  const Pose3 a_T_b{{0, 0, 0}, Turn(0.5)};
  auto matches = SamePlaces(a_T_b, {{{0, 0, 0}, Turn(0)}, {{200, 0, 0}, Turn(0)}});
  for (PlacedMatch& m : matches) m.yaw_rad += 0.3;  // both views are off
  const Alignment alignment = Align(matches, {});
  EXPECT_NEAR(geom::Yaw(alignment.a_T_b.q), 0.5, 0.03);
}

TEST(Alignment, SaysHowWellTheYawIsDetermined) {
  const Pose3 identity;
  const double alone = Align(SamePlaces(identity, {{{0, 0, 0}, Turn(0)}}), {}).yaw_sigma_rad;
  const double spread = Align(SamePlaces(identity, {{{0, 0, 0}, Turn(0)}, {{100, 0, 0}, Turn(0)}}), {}).yaw_sigma_rad;
  EXPECT_NEAR(alone, AlignmentNoise{}.yaw_sigma_rad, 1e-9);
  EXPECT_LT(spread, 0.5 * alone);
}

TEST(Alignment, RefusesToAlignNothing) {
  EXPECT_THROW((void)Align({}, {}), std::runtime_error);
}

}  // namespace
}  // namespace mapweld::merge
