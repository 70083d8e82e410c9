// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace mapweld::sim {
namespace {

const Polyline kL{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};

double AreaOf(const Polyline& polygon, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  double sum = 0;
  for (const auto& t : triangles) sum += SignedArea({polygon[t[0]], polygon[t[1]], polygon[t[2]]});
  return sum;
}

TEST(Polygon, CoversAConcaveFootprintExactly) {
  const auto triangles = Triangulate(kL);
  EXPECT_EQ(triangles.size(), 4U);
  EXPECT_DOUBLE_EQ(AreaOf(kL, triangles), SignedArea(kL));
  for (const auto& t : triangles) EXPECT_TRUE(Inside(kL, (kL[t[0]] + kL[t[1]] + kL[t[2]]) / 3));
}

TEST(Polygon, EndsOnAPolygonThatCrossesItself) {
  EXPECT_LE(Triangulate({{0, 0}, {2, 2}, {2, 0}, {0, 2}}).size(), 2U);
  EXPECT_TRUE(Triangulate({{0, 0}, {1, 0}, {2, 0}}).empty());
}

TEST(Polygon, MeasuresDistancesInsideAndOutside) {
  EXPECT_EQ(DistanceToPolygon(kL, {0.5, 0.5}), 0);
  EXPECT_NEAR(DistanceToPolygon(kL, {2, 2}), 1.0, 1e-12);
  EXPECT_NEAR(DistanceToPolygon(kL, {-3, -4}), 5.0, 1e-12);
}

TEST(Polyline, ResamplesToEvenStepsAndKeepsItsEnds) {
  const Polyline line = Resample({{0, 0}, {3, 0}, {3, 4}}, 0.5);
  ASSERT_EQ(line.size(), 15U);
  EXPECT_EQ(line.front(), Vec2d(0, 0));
  EXPECT_EQ(line.back(), Vec2d(3, 4));
  for (std::size_t i = 1; i < line.size(); ++i) EXPECT_NEAR((line[i] - line[i - 1]).norm(), 0.5, 1e-9);
}

}  // namespace
}  // namespace mapweld::sim
