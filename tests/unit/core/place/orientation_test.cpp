// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/place/describer.hpp"
#include "core/place/descriptor.hpp"
#include "tests/unit/core/place/made_up_town.hpp"

namespace mapweld::place {
namespace {

using testing::Degrees;
using testing::LookAt;
using testing::MakeTown;
using testing::View;

OrientationSignature Signature(std::uint64_t town, const View& view) {
  const auto describer = std::make_unique<Describer>();
  PlaceDescription description;
  EXPECT_EQ(describer->Describe(*LookAt(MakeTown(town), view), &description), Status::kOk);
  return description.orientation;
}

float ErrorDegrees(float yaw_rad, float expected_degrees) {
  const float error = yaw_rad * 180.0F / std::numbers::pi_v<float> - expected_degrees;
  return std::abs(std::remainder(error, 360.0F));
}

TEST(RelativeYaw, IsTheHeadingOfTheSecondViewInTheFrameOfTheFirst) {
  for (const std::uint64_t town : {21U, 22U, 23U}) {
    const OrientationSignature a = Signature(town, {.yaw_rad = Degrees(40)});
    for (const float degrees : {0.0F, 15.0F, 30.0F, 90.0F, 180.0F, -15.0F, -30.0F, -90.0F, 61.3F}) {
      const OrientationSignature b = Signature(town, {.yaw_rad = Degrees(40 + degrees)});
      const RelativeYaw yaw = EstimateRelativeYaw(a, b);
      EXPECT_LT(ErrorDegrees(yaw.yaw_rad, degrees), 1.5F) << "town " << town << ", " << degrees << " degrees";
      EXPECT_GT(yaw.score, 0.9F);
    }
  }
}

TEST(RelativeYaw, HoldsFromTheOppositeLane) {
  for (const std::uint64_t town : {31U, 32U, 33U, 34U, 35U}) {
    const OrientationSignature a = Signature(town, {.y_m = -1.75F});
    const OrientationSignature b =
        Signature(town, {.x_m = 1, .y_m = 1.75F, .yaw_rad = Degrees(175), .dropped_share = 0.3F});
    EXPECT_LT(ErrorDegrees(EstimateRelativeYaw(a, b).yaw_rad, 175), 3) << "town " << town;
  }
}

TEST(RelativeYaw, ChangesItsSignWhenTheViewsChangePlaces) {
  const OrientationSignature a = Signature(24, {});
  const OrientationSignature b = Signature(24, {.yaw_rad = Degrees(70)});
  const RelativeYaw ab = EstimateRelativeYaw(a, b);
  const RelativeYaw ba = EstimateRelativeYaw(b, a);
  EXPECT_NEAR(ab.yaw_rad, -ba.yaw_rad, 1e-4F);
  EXPECT_FLOAT_EQ(ab.score, ba.score);
}

TEST(RelativeYaw, IsZeroWithFullScoreBetweenAViewAndItself) {
  const OrientationSignature a = Signature(25, {});
  const RelativeYaw yaw = EstimateRelativeYaw(a, a);
  EXPECT_NEAR(yaw.yaw_rad, 0, 1e-6F);
  EXPECT_FLOAT_EQ(yaw.score, 1);
}

TEST(RelativeYaw, ScoresTheSamePlaceAboveAnother) {
  const OrientationSignature here = Signature(26, {});
  const OrientationSignature again = Signature(26, {.y_m = 2, .yaw_rad = Degrees(20)});
  const OrientationSignature elsewhere = Signature(27, {.yaw_rad = Degrees(20)});
  EXPECT_GT(EstimateRelativeYaw(here, again).score, EstimateRelativeYaw(here, elsewhere).score + 0.1F);
}

TEST(RelativeYaw, HasNoScoreForSignaturesThatSayNothing) {
  const OrientationSignature nothing;
  const OrientationSignature something = Signature(28, {});
  for (const auto& [a, b] :
       {std::pair(nothing, nothing), std::pair(nothing, something), std::pair(something, nothing)}) {
    const RelativeYaw yaw = EstimateRelativeYaw(a, b);
    EXPECT_EQ(yaw.score, 0);
    EXPECT_TRUE(std::isfinite(yaw.yaw_rad));
  }
}

TEST(RelativeYaw, StaysInRangeForBytesThatNobodyComputed) {
  OrientationSignature lowest;
  lowest.q.fill(-128);
  OrientationSignature mixed;
  for (std::size_t i = 0; i < mixed.q.size(); ++i) mixed.q[i] = static_cast<std::int8_t>(i % 3 == 0 ? 127 : -128);
  for (const auto& a : {lowest, mixed}) {
    for (const auto& b : {lowest, mixed}) {
      const RelativeYaw yaw = EstimateRelativeYaw(a, b);
      EXPECT_LE(std::abs(yaw.score), 1);
      EXPECT_LE(std::abs(yaw.yaw_rad), std::numbers::pi_v<float> + 1e-6F);
    }
  }
}

}  // namespace
}  // namespace mapweld::place
