// SPDX-License-Identifier: Apache-2.0
// What the demo's four drives promise to everything that is shown and tested with them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "tools/sim/sim_world.hpp"
#include "tools/sim/vehicle_motion.hpp"

namespace mapweld::sim {
namespace {

class DemoDrives : public testing::Test {
 protected:
  static void SetUpTestSuite() { world_ = new SimWorld(ReadScenario(ScenarioByName("four_drives")), 1); }
  static void TearDownTestSuite() { delete world_; }
  static SharedStreet Shared(std::size_t a, std::size_t b) {  // by id
    return FindSharedStreet(world_->route(a - 1), world_->route(b - 1));
  }
  static LanePath Lane(std::size_t vehicle) { return world_->PlanLane(vehicle); }
  static SimWorld* world_;
};
SimWorld* DemoDrives::world_ = nullptr;

TEST_F(DemoDrives, AreAboutAKilometreLong) {
  ASSERT_EQ(world_->vehicles(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_GT(Lane(i).length_m(), 900) << i;
    EXPECT_LT(Lane(i).length_m(), 1200) << i;
    EXPECT_LT(VehicleMotion(Lane(i), DrivingStyle{}, world_->relief(), 1).duration_s(), 170) << i;
  }
}

TEST_F(DemoDrives, OverlapInOneConnectedGroup) {
  EXPECT_GT(Shared(1, 2).opposite_direction_m, 300) << "in opposite directions";
  EXPECT_GT(Shared(2, 3).same_direction_m, 300);
  EXPECT_GT(Shared(3, 4).same_direction_m, 200);
  EXPECT_GT(Shared(1, 4).same_direction_m, 120);
  EXPECT_GT(Shared(2, 4).same_direction_m, 200);
}

TEST_F(DemoDrives, NeverPassTheSamePlaceTwice) {
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& nodes = world_->route(i).nodes;
    EXPECT_EQ(std::set<std::uint32_t>(nodes.begin(), nodes.end()).size(), nodes.size()) << i;
  }
}

TEST_F(DemoDrives, HaveHousesOnBothSidesMostOfTheWay) {
  for (std::size_t i = 0; i < 4; ++i) {
    const LanePath lane = Lane(i);
    int both = 0;
    int places = 0;
    for (double s = 0; s < lane.length_m(); s += 10) {
      const Vec2d left(-std::sin(lane.Heading(s)), std::cos(lane.Heading(s)));
      const auto house_near = [&](const Vec2d& towards) {
        for (const Building& building : world_->town().buildings) {
          if (DistanceToPolygon(building.footprint, lane.Position(s) + 18 * towards) < 17) return true;
        }
        return false;
      };
      both += house_near(left) && house_near(-left) ? 1 : 0;
      ++places;
    }
    EXPECT_GT(both, 0.65 * places) << i;
  }
}

TEST_F(DemoDrives, NeverTouchAnything) {
  constexpr float kClearance_m = 1.1F;  // half a car and a hand's breadth
  for (std::size_t i = 0; i < 4; ++i) {
    const LanePath lane = Lane(i);
    const RayCaster caster = world_->CasterOf(i);
    for (double s = 0; s < lane.length_m(); s += 0.5) {
      const Eigen::Vector2f p = lane.Position(s).cast<float>();
      for (const float height : {0.3F, 1.0F, 2.0F}) {
        RayPacket rays;
        for (std::size_t k = 0; k < RayPacket::kRays; ++k) {
          const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / RayPacket::kRays;
          rays.origin_x[k] = p.x();
          rays.origin_y[k] = p.y();
          rays.origin_z[k] = height + static_cast<float>(world_->relief().Height(lane.Position(s)));
          rays.direction_x[k] = std::cos(angle);
          rays.direction_y[k] = std::sin(angle);
          rays.direction_z[k] = 0;
        }
        caster.Cast(rays, kClearance_m);
        for (std::size_t k = 0; k < RayPacket::kRays; ++k) {
          ASSERT_EQ(rays.distance_m[k], 0) << "vehicle " << i + 1 << " after " << s << " m at " << p.transpose()
                                           << ", surface " << static_cast<int>(rays.surface[k]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace mapweld::sim
