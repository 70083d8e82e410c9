// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/relief.hpp"

#include <gtest/gtest.h>

#include "tools/sim/vehicle_motion.hpp"

namespace mapweld::sim {
namespace {

TEST(Relief, RisesAndFallsAsMuchAsAskedAndNoMoreSteeplyThanPromised) {
  const Relief hills(5, 3);
  double squares = 0;
  int n = 0;
  for (double x = -2000; x < 2000; x += 37) {
    for (double y = -2000; y < 2000; y += 41) {
      const Vec2d p(x, y);
      squares += hills.Height(p) * hills.Height(p);
      ++n;
      const Vec2d east(0.01, 0);
      ASSERT_NEAR(hills.Slope(p).x(), (hills.Height(p + east) - hills.Height(p - east)) / 0.02, 1e-4);
      ASSERT_LT(hills.Slope(p).norm(), 5 * 0.067);
    }
  }
  EXPECT_NEAR(std::sqrt(squares / n), 5, 1);
  EXPECT_EQ(Relief(0, 3).Height({12, 34}), 0);
}

TEST(Relief, CarriesTheVehicleAndTiltsItWithTheRoad) {
  const Relief hills(5, 3);
  const LanePath lane = LanePath::Beside({{0, 0}, {400, 0}});
  const VehicleMotion motion(lane, DrivingStyle{}, hills, 1);
  double steepest = 0;
  for (double t = 5; t < motion.duration_s() - 5; t += 0.5) {
    const geom::Pose3 world_T_body = motion.WorldFromBody(t);
    const Vec2d at = world_T_body.t.head<2>();
    EXPECT_NEAR(world_T_body.t.z() - hills.Height(at), kBodyHeight_m, 0.02);
    const geom::Vec3d forward = world_T_body.q * geom::Vec3d::UnitX();
    const double uphill = hills.Slope(at).dot(forward.head<2>());
    EXPECT_NEAR(forward.z(), uphill, 0.03) << "but for what the springs do";
    steepest = std::max(steepest, std::abs(uphill));
  }
  EXPECT_GT(steepest, 0.05) << "too flat to prove anything";
}

}  // namespace
}  // namespace mapweld::sim
