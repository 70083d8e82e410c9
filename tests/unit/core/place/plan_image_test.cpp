// SPDX-License-Identifier: Apache-2.0
#include "core/place/plan_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/place/column_grid.hpp"
#include "tests/unit/core/place/made_up_town.hpp"

namespace mapweld::place {
namespace {

using testing::LookAt;
using testing::MakeTown;

std::unique_ptr<PlanImage> ImageOf(const submap::Submap& submap) {
  const auto grid = std::make_unique<ColumnGrid>();
  EXPECT_EQ(grid->Build(submap.points.span(), 100), Status::kOk);
  auto image = std::make_unique<PlanImage>();
  image->Build(*grid);
  return image;
}

double RootMeanSquare(const PlanImage& image, std::size_t band) {
  double squares = 0;
  for (std::size_t ring = 0; ring < PlanImage::kRings; ++ring) {
    for (std::size_t d = 0; d < PlanImage::kDirections; ++d) squares += std::pow(image.At(band, ring, d), 2);
  }
  return std::sqrt(squares / (PlanImage::kRings * PlanImage::kDirections));
}

TEST(PlanImage, IsScaledByItsFirstBand) {
  EXPECT_NEAR(RootMeanSquare(*ImageOf(*LookAt(MakeTown(1), {})), 0), static_cast<double>(PlanImage::kMean), 0.5);
}

TEST(PlanImage, LeavesTheUpperBandsEmptyWhereNothingIsTall) {
  auto submap = LookAt(MakeTown(2), {});
  for (std::size_t i = 0; i < submap->points.size(); ++i) submap->points[i].z *= 0.1F;  // at most 0.9 m
  const auto image = ImageOf(*submap);
  EXPECT_GT(RootMeanSquare(*image, 0), 60);
  EXPECT_EQ(RootMeanSquare(*image, 1), 0);
  EXPECT_EQ(RootMeanSquare(*image, 2), 0);
}

TEST(PlanImage, ShiftsAlongTheDirectionsWhenTheVehicleTurns) {
  auto submap = LookAt(MakeTown(3), {});
  const auto ahead = ImageOf(*submap);
  constexpr std::size_t kShift = 16;  // an eighth of a turn
  const auto angle = static_cast<float>(std::numbers::pi * kShift / PlanImage::kDirections);
  for (std::size_t i = 0; i < submap->points.size(); ++i) {
    submap::SubmapPoint& p = submap->points[i];
    const float x = p.x;
    p.x = std::cos(angle) * x - std::sin(angle) * p.y;
    p.y = std::sin(angle) * x + std::cos(angle) * p.y;
  }
  const auto turned = ImageOf(*submap);
  const auto apart = [&](std::size_t shift) {
    double squares = 0;
    for (std::size_t ring = 0; ring < PlanImage::kRings; ++ring) {
      for (std::size_t d = 0; d < PlanImage::kDirections; ++d) {
        const int difference = turned->At(0, ring, (d + shift) % PlanImage::kDirections) - ahead->At(0, ring, d);
        squares += difference * difference;
      }
    }
    return std::sqrt(squares);
  };
  EXPECT_LT(apart(kShift), 0.3 * apart(0));
}

}  // namespace
}  // namespace mapweld::place
