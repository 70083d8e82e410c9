// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/procedural_town.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/unit/tools/sim/test_folder.hpp"
#include "tools/sim/road_graph.hpp"
#include "tools/sim/survey.hpp"

namespace mapweld::sim {
namespace {

class InventedTown : public testing::TestWithParam<const char*> {
 protected:
  const Town town_ = InventTown({GetParam(), 900, 5});
};

TEST_P(InventedTown, HasStreetsThatAFleetCanDrive) {
  const RoadGraph graph(town_.roads);
  const auto drives = PlanSurvey(graph, {2, 1, 600, 200, 1000, 2000, 3000}, 1);
  EXPECT_EQ(drives.size(), 2U);
}

TEST_P(InventedTown, GivesEveryPieceOfStreetAnIdOfItsOwn) {
  std::set<std::int64_t> ids;
  for (const Road& road : town_.roads) {
    EXPECT_TRUE(ids.insert(road.id).second) << road.id;
    ASSERT_EQ(road.nodes.size(), road.line.size());
  }
}

TEST_P(InventedTown, KeepsHousesOffTheCarriageways) {
  ASSERT_GT(town_.buildings.size(), 40U);
  for (const Building& building : town_.buildings) {
    ASSERT_GT(SignedArea(building.footprint), 20) << building.id;
    for (const Road& road : town_.roads) {
      for (std::size_t i = 1; i < road.line.size(); ++i) {
        if ((road.line[i] - building.footprint.front()).norm() > 150) continue;
        for (const Vec2d& corner : building.footprint) {
          ASSERT_GT(DistanceToSegment(corner, road.line[i - 1], road.line[i]), road.half_width_m)
              << "house " << building.id << " on street " << road.id;
        }
      }
    }
  }
}

TEST_P(InventedTown, DependsOnItsSeedOnly) {
  const Town again = InventTown({GetParam(), 900, 5});
  ASSERT_EQ(again.buildings.size(), town_.buildings.size());
  for (std::size_t i = 0; i < again.buildings.size(); ++i) {
    ASSERT_EQ(again.buildings[i].footprint, town_.buildings[i].footprint);
  }
  const Town other = InventTown({GetParam(), 900, 6});
  EXPECT_NE(other.roads.front().line, town_.roads.front().line);
}

INSTANTIATE_TEST_SUITE_P(OfEveryStyle, InventedTown, testing::Values("old_town", "suburb", "industry", "estate"));

TEST(InventedTownErrors, NameTheStylesThereAre) {
  EXPECT_THAT(MessageOf([] { (void)InventTown({"atlantis", 900, 5}); }), testing::HasSubstr("old_town, suburb"));
}

}  // namespace
}  // namespace mapweld::sim
