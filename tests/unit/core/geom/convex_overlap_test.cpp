// SPDX-License-Identifier: Apache-2.0
#include "core/geom/convex_overlap.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

namespace mapweld::geom {
namespace {

OrientedBox BoxAt(double x, double y, double yaw_rad, Vec3d half = {2, 1, 1}) {
  return {{{x, y, 0}, Quatd(Eigen::AngleAxisd(yaw_rad, Vec3d::UnitZ()))}, half};
}

// The oracle: separating axes of two boxes (Gottschalk, Lin, Manocha, SIGGRAPH 1996). Positive = gap, negative = depth.
double Gap(const OrientedBox& a, const OrientedBox& b) {
  const Mat3d ra = a.world_T_box.q.toRotationMatrix();
  const Mat3d rb = b.world_T_box.q.toRotationMatrix();
  std::vector<Vec3d> axes;
  for (int i = 0; i < 3; ++i) {
    axes.push_back(ra.col(i));
    axes.push_back(rb.col(i));
    for (int k = 0; k < 3; ++k) axes.push_back(ra.col(i).cross(rb.col(k)));
  }
  double gap = -std::numeric_limits<double>::infinity();
  for (Vec3d axis : axes) {
    if (axis.norm() < 1e-6) continue;
    axis.normalize();
    const double reach =
        (ra.transpose() * axis).cwiseAbs().dot(a.half_extent) + (rb.transpose() * axis).cwiseAbs().dot(b.half_extent);
    gap = std::max(gap, std::abs(axis.dot(a.world_T_box.t - b.world_T_box.t)) - reach);
  }
  return gap;
}

TEST(ConvexOverlap, SeesBoxesThatMeetAndBoxesThatDoNot) {
  EXPECT_TRUE(BoxesOverlap(BoxAt(0, 0, 0), BoxAt(3.9, 0, 0)));
  EXPECT_FALSE(BoxesOverlap(BoxAt(0, 0, 0), BoxAt(4.1, 0, 0)));
}

TEST(ConvexOverlap, CountsTheTurnOfABox) {
  EXPECT_FALSE(BoxesOverlap(BoxAt(0, 0, 0), BoxAt(0, 2.5, 0)));
  EXPECT_TRUE(BoxesOverlap(BoxAt(0, 0, 0), BoxAt(0, 2.5, 1.5707963)));
}

TEST(ConvexOverlap, SeesABoxInsideAnother) {
  EXPECT_TRUE(BoxesOverlap(BoxAt(0, 0, 0, {50, 50, 10}), BoxAt(1, 2, 0.3)));
  EXPECT_TRUE(BoxesOverlap(BoxAt(0, 0, 0), BoxAt(0, 0, 0)));
}

TEST(ConvexOverlap, AgreesWithSeparatingAxesOnRandomBoxes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  int meeting = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto box = [&] {
      return OrientedBox{
          {{3 * u(random), 3 * u(random), 3 * u(random)}, ExpSo3({2 * u(random), 2 * u(random), 2 * u(random)})},
          {1.1 + u(random), 1.1 + u(random), 1.1 + u(random)}};
    };
    const OrientedBox a = box();
    const OrientedBox b = box();
    const double gap = Gap(a, b);
    if (std::abs(gap) < 1e-3) continue;
    meeting += gap < 0 ? 1 : 0;
    ASSERT_EQ(BoxesOverlap(a, b), gap < 0) << "case " << i << ", gap " << gap;
  }
  EXPECT_GT(meeting, 4000);
  EXPECT_LT(meeting, 18000);
}

TEST(ConvexOverlap, RefusesBoxesThatAreNotFinite) {
  OrientedBox broken = BoxAt(0, 0, 0);
  broken.half_extent.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(BoxesOverlap(broken, BoxAt(0, 0, 0)));
  broken = BoxAt(0, 0, 0);
  broken.world_T_box.t.y() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(BoxesOverlap(BoxAt(0, 0, 0), broken));
}

}  // namespace
}  // namespace mapweld::geom
