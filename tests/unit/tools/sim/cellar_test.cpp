// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/cellar.hpp"

#include <gtest/gtest.h>

#include "tools/sim/cellar_mesh.hpp"
#include "tools/sim/procedural_town.hpp"
#include "tools/sim/ray_caster.hpp"
#include "tools/sim/relief.hpp"
#include "tools/sim/vehicle_motion.hpp"

namespace mapweld::sim {
namespace {

constexpr double kDepth_m = 3.4;

class CellarTown : public testing::Test {
 protected:
  CellarTown() {
    std::vector<const Polyline*> lines;
    for (const Road& road : town_.roads) lines.push_back(&road.line);
    const Sight sight(lines, 20);
    scene_ = std::make_shared<RayScene>(BuildTownMesh(town_, sight, sight));
  }
  // The distance to what is met first; 0 for the sky.
  [[nodiscard]] double Look(const Vec2d& from, double z, double direction_z) const {
    RayPacket rays{};
    rays.origin_x.fill(static_cast<float>(from.x()));
    rays.origin_y.fill(static_cast<float>(from.y()));
    rays.origin_z.fill(static_cast<float>(z));
    rays.direction_z.fill(static_cast<float>(direction_z));
    RayCaster({scene_}).Cast(rays, 200);
    return static_cast<double>(rays.distance_m[0]);
  }
  // The middles of all streets that lie below.
  [[nodiscard]] std::vector<Vec2d> StreetsBelow() const {
    std::vector<Vec2d> middles;
    for (const Passage& passage : town_.passages) middles.push_back(passage.line[passage.line.size() / 2]);
    return middles;
  }

  const Town town_ = InventTown({"plaza", 420, 51, kDepth_m});
  std::shared_ptr<const RayScene> scene_;
};

TEST_F(CellarTown, HasStreetsUnderAClosedCeilingWithASquareAbove) {
  ASSERT_GT(StreetsBelow().size(), 30U);
  for (const Vec2d& p : StreetsBelow()) {
    EXPECT_NEAR(town_.cellar->Depth(p), kDepth_m, 1e-9);
    EXPECT_NEAR(Look(p, 1 - kDepth_m, 1), Cellar::kCeiling_m - 1, 1e-3) << "up to the ceiling";
    EXPECT_NEAR(Look(p, 1 - kDepth_m, -1), 1, 1e-3) << "down to the street";
    EXPECT_NEAR(Look(p, 5, -1), 5.05, 1e-3) << "the ground above";
  }
}

TEST_F(CellarTown, GoesDownOpenRampsThatNothingStandsOn) {
  const std::vector<Ramp> ramps = RampsOf(town_);
  ASSERT_GE(ramps.size(), 2U);
  for (const Ramp& ramp : ramps) {
    double open_m = 0;
    for (const Vec2d& p : Resample(ramp.line, 1)) {
      const double depth = town_.cellar->Depth(p);
      const bool roofed = town_.cellar->out.dot(p) < town_.cellar->edge_m + 0.5;  // the ground is cut by half metres
      if (roofed || depth < 0.2) continue;
      EXPECT_NEAR(Look(p, 5, -1), 5 + depth, 0.01) << "no ground over the trench, at depth " << depth;
      open_m += 1;
    }
    EXPECT_GT(open_m, 15);
  }
}

TEST_F(CellarTown, CarriesAVehicleDownAndTiltsIt) {
  const Relief relief(0, 1, town_.cellar);
  const Ramp ramp = RampsOf(town_).front();
  Polyline line = ramp.line;
  if (town_.cellar->Depth(line.front()) > 1) line = Polyline(line.rbegin(), line.rend());
  const Vec2d along = (line.back() - line.front()).normalized();
  line.insert(line.begin(), line.front() - 40 * along);
  line.push_back(line.back() + 40 * along);
  DrivingStyle style;
  style.max_speed_mps = 4;
  const VehicleMotion motion(LanePath::Beside(line), style, relief, 1);
  EXPECT_NEAR(motion.WorldFromBody(motion.duration_s()).t.z(), kBodyHeight_m - kDepth_m, 0.05);
  double steepest = 0;
  for (double t = 0; t < motion.duration_s(); t += 0.1) {
    const geom::Pose3 world_T_body = motion.WorldFromBody(t);
    EXPECT_NEAR(world_T_body.t.z(), kBodyHeight_m - town_.cellar->Depth(world_T_body.t.head<2>()), 0.05);
    steepest = std::min(steepest, (world_T_body.q * geom::Vec3d::UnitX()).z());
  }
  EXPECT_NEAR(steepest, -std::sin(std::atan(1.5 * kDepth_m / town_.cellar->ramp_m)), 0.03);
}

TEST(Cellar, HasTheSlopeOfItsDepth) {
  Cellar cellar;
  cellar.out = Vec2d(0.6, 0.8);
  cellar.edge_m = 10;
  cellar.ramp_m = 25;
  cellar.depth_m = 4;
  for (double s = 0; s < 50; s += 0.7) {
    const Vec2d p = s * cellar.out + Vec2d(-8, 6);
    const Vec2d step = 1e-4 * cellar.out;
    EXPECT_NEAR(cellar.Slope(p).dot(cellar.out), (cellar.Depth(p - step) - cellar.Depth(p + step)) / 2e-4, 1e-4);
  }
  EXPECT_EQ(cellar.Depth({0, 0}), 4);
  EXPECT_EQ(cellar.Depth(40 * cellar.out), 0);
}

TEST(Cellar, IsNotThereUnlessAskedFor) {
  const Town town = InventTown({"plaza", 420, 51, 0});
  EXPECT_FALSE(town.cellar.has_value());
  EXPECT_TRUE(RampsOf(town).empty());
}

}  // namespace
}  // namespace mapweld::sim
