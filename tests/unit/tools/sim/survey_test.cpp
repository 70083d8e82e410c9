// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/survey.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/unit/tools/sim/test_folder.hpp"

namespace mapweld::sim {
namespace {

using testing::HasSubstr;

// Two towns of 5 x 5 blocks, 2 km apart and joined by one road, with a dead end sticking out of the first.
class Survey : public testing::Test {
 protected:
  Survey() {
    for (const double x0 : {0.0, 2000.0}) {
      for (int i = 0; i <= 5; ++i) {
        AddRoad({x0, 100.0 * i}, {x0 + 500, 100.0 * i});
        AddRoad({x0 + 100.0 * i, 0}, {x0 + 100.0 * i, 500});
      }
    }
    AddRoad({500, 200}, {2000, 200});
    AddRoad({0, 300}, {-300, 300});
    plan_ = {8, 2, 420, 200, 300, 3000, 700 * 8};
  }
  // A node every 100 m, shared where roads meet.
  void AddRoad(const Vec2d& from, const Vec2d& to) {
    Road road{static_cast<std::int64_t>(roads_.size()), {}, {}, 3, true};
    const int steps = static_cast<int>(std::lround((to - from).norm() / 100));
    for (int k = 0; k <= steps; ++k) {
      const Vec2d p = from + (to - from) * (static_cast<double>(k) / steps);
      road.nodes.push_back(std::lround(p.x()) * 10000 + std::lround(p.y()));
      road.line.push_back(p);
    }
    roads_.push_back(road);
  }
  [[nodiscard]] std::vector<SurveyedDrive> Plan(std::uint64_t seed = 1) const {
    return PlanSurvey(RoadGraph(roads_), plan_, seed);
  }
  std::vector<Road> roads_;
  SurveyPlan plan_;
};

TEST_F(Survey, KeepsEveryDriveInItsZone) {
  std::set<int> zones;
  for (const SurveyedDrive& drive : Plan()) {
    zones.insert(drive.zone);
    const bool first_town = drive.path.centreline.front().x() < 1000;
    for (const Vec2d& p : drive.path.centreline) EXPECT_EQ(p.x() < 1000, first_town);
  }
  EXPECT_EQ(zones.size(), 2U);
}

TEST_F(Survey, DrivesTheTotalThatWasAskedFor) {
  double sum = 0;
  for (const SurveyedDrive& drive : Plan()) {
    const double length = Length(drive.path.centreline);
    EXPECT_GE(length, plan_.min_length_m);
    EXPECT_LE(length, plan_.max_length_m + RoadGraph::kMaxEdge_m);
    sum += length;
  }
  EXPECT_NEAR(sum, plan_.total_length_m, 8 * RoadGraph::kMaxEdge_m);
}

TEST_F(Survey, NeverTurnsBackAndNeverEntersADeadEnd) {
  for (const SurveyedDrive& drive : Plan()) {
    const std::vector<std::uint32_t>& nodes = drive.path.nodes;
    for (std::size_t i = 2; i < nodes.size(); ++i) EXPECT_NE(nodes[i], nodes[i - 2]);
    for (const Vec2d& p : drive.path.centreline) EXPECT_GT(p.x(), -1);
  }
}

TEST_F(Survey, DependsOnTheSeedOnly) {
  const auto a = Plan(5);
  const auto b = Plan(5);
  const auto c = Plan(6);
  EXPECT_EQ(a[3].path.nodes, b[3].path.nodes);
  EXPECT_NE(a[3].path.nodes, c[3].path.nodes);
}

TEST_F(Survey, SaysWhenTheTownIsTooSmall) {
  plan_.zones = 7;
  EXPECT_THAT(MessageOf([&] { (void)Plan(); }), HasSubstr("room for 2 zones"));
}

TEST_F(Survey, DrivesEveryRouteAsOftenAsAskedForwardsAndBackwards) {
  plan_.runs = 4;
  const auto drives = Plan();
  ASSERT_EQ(drives.size(), 8U);
  EXPECT_EQ(drives[0].path.nodes, drives[2].path.nodes);
  auto back = drives[1].path.nodes;
  std::reverse(back.begin(), back.end());
  EXPECT_EQ(drives[0].path.nodes, back);
  EXPECT_EQ(drives[1].path.centreline.front(), drives[0].path.centreline.back());
  EXPECT_NE(drives[0].path.nodes, drives[4].path.nodes) << "the second route";
}

TEST_F(Survey, GoesStraightOnWhenAskedToAndSharesNoStreet) {
  plan_ = {6, 1, 420, 200, 300, 300, 6 * 300.0};
  plan_.straight_on = true;
  const auto drives = Plan();
  for (std::size_t a = 0; a < drives.size(); ++a) {
    EXPECT_NEAR(Length(drives[a].path.centreline), 300, 6);
    EXPECT_NEAR((drives[a].path.centreline.back() - drives[a].path.centreline.front()).norm(), 300, 6) << "straight";
    for (std::size_t b = 0; b < a; ++b) {
      const SharedStreet shared = FindSharedStreet(drives[a].path, drives[b].path);
      EXPECT_EQ(shared.same_direction_m + shared.opposite_direction_m, 0);
    }
  }
}

}  // namespace
}  // namespace mapweld::sim
