// SPDX-License-Identifier: Apache-2.0
#include "core/place/column_grid.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace mapweld::place {
namespace {

using submap::SubmapPoint;

// Eight corners of a large box, each seen twice, so that the cloud is neither empty nor flat; they stand alone in their
// cells and far from what a test looks at.
std::vector<SubmapPoint> Frame() {
  std::vector<SubmapPoint> points;
  for (const float x : {-40.2F, 40.2F}) {
    for (const float y : {-40.2F, 40.2F}) {
      for (const float z : {0.0F, 20.0F}) points.push_back({.x = x, .y = y, .z = z});
    }
  }
  return points;
}

std::vector<Column> ColumnsNearOrigin(const std::vector<SubmapPoint>& points) {
  const auto grid = std::make_unique<ColumnGrid>();
  EXPECT_EQ(grid->Build(points, 1), Status::kOk);
  std::vector<Column> columns;
  grid->ForEach([&columns](const Column& c) {
    if (std::abs(c.x_q8) < 30 * kQ8 && std::abs(c.y_q8) < 30 * kQ8) columns.push_back(c);
  });
  return columns;
}

TEST(ColumnGrid, WeighsAPoleByItsPointsAndFlatGroundLittle) {
  std::vector<SubmapPoint> points = Frame();
  for (float z = 0; z < 2; z += 0.5F) points.push_back({.x = 10.1F, .y = 5.1F, .z = z});
  points.push_back({.x = -10.1F, .y = 5.1F, .z = 0});
  const auto columns = ColumnsNearOrigin(points);
  ASSERT_EQ(columns.size(), 2U);
  EXPECT_EQ(columns[0].weight_q8, kQ8 / 4);
  EXPECT_EQ(columns[1].weight_q8, kQ8 / 4 + 3 * kQ8);
}

TEST(ColumnGrid, MeasuresHeightOverTheNeighboursToo) {
  std::vector<SubmapPoint> points = Frame();
  points.push_back({.x = 10.1F, .y = 5.1F, .z = 1.0F});
  points.push_back({.x = 10.6F, .y = 5.6F, .z = 0.0F});
  const auto columns = ColumnsNearOrigin(points);
  ASSERT_EQ(columns.size(), 2U);
  EXPECT_EQ(columns[0].weight_q8, kQ8);
  EXPECT_EQ(columns[1].weight_q8, kQ8 / 4);
}

TEST(ColumnGrid, PutsAColumnAtTheCentreOfItsWeight) {
  std::vector<SubmapPoint> points = Frame();
  points.push_back({.x = -10.5F, .y = 5.0F, .z = 3});
  points.push_back({.x = -10.25F, .y = 5.25F, .z = 3});
  const auto columns = ColumnsNearOrigin(points);
  ASSERT_EQ(columns.size(), 1U);
  EXPECT_EQ(columns[0].x_q8, -10 * kQ8 - 3 * kQ8 / 8);
  EXPECT_EQ(columns[0].y_q8, 5 * kQ8 + kQ8 / 8);
}

TEST(ColumnGrid, CountsNoColumnWithoutEnd) {
  std::vector<SubmapPoint> points = Frame();
  for (int i = 0; i < 5000; ++i) points.push_back({.x = 10.1F, .y = 5.1F, .z = static_cast<float>(i) * 0.01F});
  const auto columns = ColumnsNearOrigin(points);
  ASSERT_EQ(columns.size(), 1U);
  EXPECT_EQ(columns[0].weight_q8, ColumnGrid::kMaxWeightQ8);
}

TEST(ColumnGrid, KeepsPointsOnItsVeryEdgeInside) {
  std::vector<SubmapPoint> points = Frame();
  for (const float edge : {-50.0F, 49.99F}) points.push_back({.x = edge, .y = edge, .z = 1});
  points.push_back({.x = 50.0F, .y = 0, .z = 1});
  const auto grid = std::make_unique<ColumnGrid>();
  EXPECT_EQ(grid->Build(points, 10), Status::kOk);
  EXPECT_EQ(grid->Build(points, 11), Status::kBadInput);
}

}  // namespace
}  // namespace mapweld::place
