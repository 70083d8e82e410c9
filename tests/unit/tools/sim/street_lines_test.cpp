// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/street_lines.hpp"

#include <gtest/gtest.h>

#include <map>

namespace mapweld::sim {
namespace {

Area Box(double x, double y, double width, double height) {
  return {{{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}}};
}

// How many streets end in each node.
std::map<std::int64_t, int> Ends(const std::vector<Road>& roads) {
  std::map<std::int64_t, int> ends;
  for (const Road& road : roads) {
    ++ends[road.nodes.front()];
    ++ends[road.nodes.back()];
  }
  return ends;
}

TEST(StreetLines, FindsTheMiddleAndTheWidthOfALoneStreet) {
  const auto roads = StreetLines({Box(0, 0, 80, 7)});
  ASSERT_EQ(roads.size(), 1U);
  EXPECT_NEAR(roads[0].half_width_m, 3.5, 0.4);
  EXPECT_EQ(roads[0].nodes.size(), roads[0].line.size());
  for (const Vec2d& p : roads[0].line) EXPECT_NEAR(p.y(), 3.5, 0.5);
}

TEST(StreetLines, JoinsAreasThatTouchAndCutsThemAtAJunction) {
  // A street in two pieces, and one that comes from the south.
  const auto roads = StreetLines({Box(0, 0, 50, 6), Box(50, 0, 50, 6), Box(47, -60, 6, 60)});
  ASSERT_EQ(roads.size(), 3U);
  int junctions = 0;
  for (const auto& [node, count] : Ends(roads)) junctions += count == 3 ? 1 : 0;
  EXPECT_EQ(junctions, 1);
}

TEST(StreetLines, GoesRoundABlock) {
  // A ring of streets about a block of 60 x 40 m, as one area with a hole.
  const Area ring{Box(0, 0, 72, 52)[0], Box(6, 6, 60, 40)[0]};
  const auto roads = StreetLines({ring});
  double length_m = 0;
  for (const Road& road : roads) length_m += Length(road.line);
  EXPECT_NEAR(length_m, 2 * (66 + 46), 20);
  for (const auto& [node, count] : Ends(roads)) EXPECT_EQ(count, 2) << "no dead end";
}

TEST(StreetLines, LeavesOutTheCornersOfWideJunctions) {
  const auto roads = StreetLines({Box(0, -4, 100, 8), Box(46, -50, 8, 100)});
  EXPECT_EQ(roads.size(), 4U);
  EXPECT_EQ(Ends(roads).size(), 5U) << "one junction, four ends";
}

TEST(StreetLines, HasNoneWithoutAreas) {
  EXPECT_TRUE(StreetLines({}).empty());
  EXPECT_TRUE(StreetLines({Area{}}).empty());
}

TEST(StreetLines, RefusesAreasThatAreTooFarApart) {
  EXPECT_THROW((void)StreetLines({Box(0, 0, 10, 10), Box(50'000, 50'000, 10, 10)}), std::runtime_error);
}

}  // namespace
}  // namespace mapweld::sim
