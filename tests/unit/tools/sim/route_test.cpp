// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/route.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tools/sim/test_folder.hpp"

namespace mapweld::sim {
namespace {

using testing::HasSubstr;

// A block of streets, 200 m x 100 m, with a shortcut through the middle, and a street of its own far away.
class Route : public testing::Test {
 protected:
  Route() {
    const auto road = [this](std::vector<std::int64_t> nodes) {
      Road r{static_cast<std::int64_t>(roads_.size()), nodes, {}, 3, true};
      for (const auto n : nodes) {
        r.line.push_back(corners_[static_cast<std::size_t>(n)]);
        bounds_.Extend(r.line.back());
      }
      roads_.push_back(r);
    };
    road({0, 1, 2});
    road({3, 4, 5});
    road({0, 3});
    road({1, 4});
    road({2, 5});
    road({6, 7});
  }
  [[nodiscard]] StreetPath Plan(const std::vector<Vec2d>& points) const {
    std::vector<GeoPoint> waypoints;
    for (const Vec2d& p : points) waypoints.push_back(frame_.ToGeo(p));
    return PlanStreetPath(RoadGraph(roads_), bounds_, frame_, waypoints, "vehicle 7");
  }
  const std::vector<Vec2d> corners_{{0, 0}, {100, 0}, {200, 0}, {0, 100}, {100, 100}, {200, 100}, {400, 0}, {400, 100}};
  LocalFrame frame_{{50, 11}};
  std::vector<Road> roads_;
  Box2 bounds_;
};

TEST_F(Route, TakesTheShortestStreets) {
  const StreetPath path = Plan({{0, 0}, {100, 98}});
  EXPECT_NEAR(Length(path.centreline), 200, 5.1);
  EXPECT_NEAR(path.centreline.back().y(), 100, 5.1);
}

TEST_F(Route, PassesAllWaypointsInOrder) {
  const StreetPath path = Plan({{0, 0}, {200, 0}, {200, 100}, {100, 100}, {100, 0}});
  EXPECT_NEAR(Length(path.centreline), 200 + 100 + 100 + 100, 0.1);
}

TEST_F(Route, MeasuresSharedStreetsByDirection) {
  const StreetPath a = Plan({{0, 0}, {200, 0}, {200, 100}});
  const StreetPath b = Plan({{100, 0}, {200, 0}, {200, 100}, {100, 100}});
  const StreetPath c = Plan({{200, 100}, {200, 0}, {100, 0}, {100, 100}});
  EXPECT_NEAR(FindSharedStreet(a, b).same_direction_m, 200, 1e-9);
  EXPECT_EQ(FindSharedStreet(a, b).opposite_direction_m, 0);
  EXPECT_NEAR(FindSharedStreet(a, c).opposite_direction_m, 200, 1e-9);
  EXPECT_EQ(FindSharedStreet(a, c).same_direction_m, 0);
}

TEST_F(Route, RefusesWaypointsThatCannotBeDriven) {
  EXPECT_THAT(MessageOf([&] {
                (void)Plan({{0, 0}, {900, 0}});
              }),
              testing::AllOf(HasSubstr("vehicle 7, waypoint 2"), HasSubstr("outside the town extract")));
  EXPECT_THAT(MessageOf([&] { (void)Plan({{50, 50}, {100, 0}}); }), HasSubstr("50 m away from the nearest street"));
  EXPECT_THAT(MessageOf([&] { (void)Plan({{0, 0}, {400, 50}}); }), HasSubstr("cannot be reached"));
  EXPECT_THAT(MessageOf([&] { (void)Plan({{0, 0}, {60, 0}, {0, 0}}); }), HasSubstr("turns back on itself"));
  EXPECT_THAT(MessageOf([&] { (void)Plan({{0, 0}}); }), HasSubstr("at least two waypoints"));
  EXPECT_THAT(MessageOf([&] { (void)Plan({{0, 0}, {10, 0}}); }), HasSubstr("at least 30 m"));
}

}  // namespace
}  // namespace mapweld::sim
