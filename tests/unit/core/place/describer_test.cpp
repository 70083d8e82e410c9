// SPDX-License-Identifier: Apache-2.0
#include "core/place/describer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/base/crc32.hpp"
#include "tests/unit/core/place/made_up_town.hpp"

namespace mapweld::place {
namespace {

using testing::Degrees;
using testing::Dice;
using testing::LookAt;
using testing::MakeTown;
using testing::View;

PlaceDescription Describe(const submap::Submap& submap, Describer::Method method = Describer::Method::kTrained) {
  const auto describer = std::make_unique<Describer>(method);
  PlaceDescription description;
  EXPECT_EQ(describer->Describe(submap, &description), Status::kOk);
  return description;
}

PlaceDescription DescribeView(std::uint64_t town, const View& view) {
  return Describe(*LookAt(MakeTown(town), view));
}

float Distance(const PlaceDescription& a, const PlaceDescription& b) {
  return CosineDistance(a.descriptor, b.descriptor);
}

submap::Submap& Scratch() {
  static submap::Submap submap;
  submap.points.clear();
  return submap;
}

void Push(submap::Submap& submap, float x, float y, float z) {
  ASSERT_EQ(submap.points.TryPush({.x = x, .y = y, .z = z, .count = 1}), Status::kOk);
}

TEST(PlaceDescriber, GivesTheSameDescriptorForEveryHeading) {
  const auto submap = LookAt(MakeTown(1), {.noise_m = 0.1F});
  const PlaceDescription ahead = Describe(*submap);
  for (const float degrees : {7.0F, 15.0F, 30.0F, 90.0F, 133.0F, 180.0F, 270.0F}) {
    submap::Submap& turned = Scratch();
    const float c = std::cos(Degrees(degrees));
    const float s = std::sin(Degrees(degrees));
    for (const submap::SubmapPoint& p : submap->points) Push(turned, c * p.x + s * p.y, c * p.y - s * p.x, p.z);
    EXPECT_LT(Distance(ahead, Describe(turned)), 0.003F) << degrees << " degrees";
  }
}

// A turned voxel grid cuts the same walls into other voxels, up to 1.4 times as many; that much change is left.
TEST(PlaceDescriber, HardlyNoticesHowTheVoxelGridLies) {
  const PlaceDescription ahead = DescribeView(1, {});
  const float at_40_m = Distance(ahead, DescribeView(1, {.x_m = 40}));
  for (const float degrees : {15.0F, 30.0F, 45.0F, 133.0F}) {
    EXPECT_LT(3 * Distance(ahead, DescribeView(1, {.yaw_rad = Degrees(degrees)})), at_40_m) << degrees << " degrees";
  }
}

TEST(PlaceDescriber, SeesNearbyViewsAsMoreAlikeThanFarOnes) {
  const PlaceDescription here = DescribeView(2, {});
  const float at_1_m = Distance(here, DescribeView(2, {.y_m = 1}));
  const float at_4_m = Distance(here, DescribeView(2, {.y_m = 4}));
  const float at_10_m = Distance(here, DescribeView(2, {.x_m = 10}));
  const float at_50_m = Distance(here, DescribeView(2, {.x_m = 50}));
  EXPECT_LT(at_1_m, at_4_m);
  EXPECT_LT(at_4_m, at_10_m);
  EXPECT_LT(at_10_m, at_50_m);
  EXPECT_LT(3 * at_4_m, at_50_m);
}

TEST(PlaceDescriber, MatchesTheOppositeLaneThoughItDrivesTheOtherWay) {
  const PlaceDescription here = DescribeView(3, {.y_m = -1.75F});
  const PlaceDescription back = DescribeView(3, {.y_m = 1.75F, .yaw_rad = Degrees(180)});
  const PlaceDescription farther = DescribeView(3, {.x_m = 30, .y_m = -1.75F});
  EXPECT_LT(3 * Distance(here, back), Distance(here, farther));
}

TEST(PlaceDescriber, TellsDifferentPlacesApartBetterThanNoiseMixesThem) {
  constexpr std::uint64_t kTowns = 8;
  std::vector<PlaceDescription> clean;
  std::vector<PlaceDescription> noisy;
  for (std::uint64_t town = 10; town < 10 + kTowns; ++town) {
    clean.push_back(DescribeView(town, {}));
    noisy.push_back(
        DescribeView(town, {.y_m = 2, .yaw_rad = Degrees(200), .dropped_share = 0.3F, .noise_m = 0.1F, .seed = town}));
  }
  float farthest_own = 0;
  float nearest_other = 2;
  for (std::size_t i = 0; i < kTowns; ++i) {
    for (std::size_t j = 0; j < kTowns; ++j) {
      const float distance = Distance(clean[i], noisy[j]);
      if (i == j) farthest_own = std::max(farthest_own, distance);
      if (i != j) nearest_other = std::min(nearest_other, distance);
    }
  }
  EXPECT_LT(1.5F * farthest_own, nearest_other);
}

TEST(PlaceDescriber, RecognisesAPlaceWithAndWithoutItsGround) {
  const PlaceDescription bare = DescribeView(4, {});
  const PlaceDescription with_ground = DescribeView(4, {.with_ground = true});
  const PlaceDescription elsewhere = DescribeView(4, {.x_m = 40, .with_ground = true});
  EXPECT_LT(1.5F * Distance(bare, with_ground), Distance(with_ground, elsewhere));
}

TEST(PlaceDescriber, IsNotMisledByASlopeOfTheStreet) {
  const PlaceDescription flat = DescribeView(5, {.with_ground = true});
  const PlaceDescription steep = DescribeView(5, {.with_ground = true, .slope = 0.1F});
  const PlaceDescription elsewhere = DescribeView(5, {.x_m = 40, .with_ground = true});
  EXPECT_LT(3 * Distance(flat, steep), Distance(flat, elsewhere));
}

TEST(PlaceDescriber, DoesNotCareHowHighTheSensorIsMounted) {
  auto submap = LookAt(MakeTown(6), {});
  const PlaceDescription car = Describe(*submap);
  for (submap::SubmapPoint& p : submap->points) p.z -= 1.5F;
  const PlaceDescription truck = Describe(*submap);
  EXPECT_LT(Distance(car, truck), 1e-4F);
}

TEST(PlaceDescriber, GivesTheSameBytesForEveryOrderOfThePoints) {
  auto submap = LookAt(MakeTown(7), {.yaw_rad = 0.3F, .with_ground = true});
  const PlaceDescription before = Describe(*submap);
  Dice dice(99);
  for (std::size_t i = submap->points.size() - 1; i > 0; --i) {
    const auto j = static_cast<std::size_t>(dice.Uniform() * static_cast<float>(i + 1));
    std::swap(submap->points[i], submap->points[j]);
  }
  const PlaceDescription after = Describe(*submap);
  EXPECT_EQ(before.descriptor.q, after.descriptor.q);
  EXPECT_EQ(before.descriptor.scale, after.descriptor.scale);
  EXPECT_EQ(before.orientation.q, after.orientation.q);
  EXPECT_EQ(before.orientation.scale, after.orientation.scale);
}

TEST(PlaceDescriber, RemembersNothingFromTheSubmapBefore) {
  const auto first = LookAt(MakeTown(8), {});
  const auto second = LookAt(MakeTown(9), {});
  const auto describer = std::make_unique<Describer>(Describer::Method::kTrained);
  PlaceDescription used;
  ASSERT_EQ(describer->Describe(*first, &used), Status::kOk);
  ASSERT_EQ(describer->Describe(*second, &used), Status::kOk);
  const PlaceDescription fresh = Describe(*second);
  EXPECT_EQ(used.descriptor.q, fresh.descriptor.q);
  EXPECT_EQ(used.orientation.q, fresh.orientation.q);
}

TEST(PlaceDescriber, GivesADescriptorOfUnitLength) {
  const PlaceDescription d = DescribeView(1, {});
  double squared = 0;
  for (const std::int8_t q : d.descriptor.q) squared += std::pow(static_cast<double>(d.descriptor.scale) * q, 2);
  EXPECT_NEAR(squared, 1, 0.01);
}

// Stored descriptors are compared with new ones for years and across machines. Should this fail after a change to the
// formulas, then the change makes all stored descriptors useless: raise the model version and put the new value here.
TEST(PlaceDescriber, GivesTheVeryBytesItGaveOnTheFirstMachine) {
  submap::Submap& submap = Scratch();
  std::uint32_t state = 12345;
  for (int i = 0; i < 6000; ++i) {
    state = state * 1664525U + 1013904223U;
    const int x = static_cast<int>((state >> 8U) % 1024U) - 512;
    state = state * 1664525U + 1013904223U;
    const int y = static_cast<int>((state >> 8U) % 1024U) - 512;
    const int z = (x * x / 512 + (y < 0 ? 7 : 31) * (i % 5)) % 96;
    Push(submap, static_cast<float>(x) / 16, static_cast<float>(y) / 16, static_cast<float>(z) / 16);
  }
  const auto checksum = [&submap](Describer::Method method) {
    const PlaceDescription d = Describe(submap, method);
    const auto bytes = [](const auto& q) {
      return std::span(reinterpret_cast<const std::uint8_t*>(q.data()), q.size());  // NOLINT: int8 as bytes
    };
    return Crc32(bytes(d.orientation.q), Crc32(bytes(d.descriptor.q)));
  };
  EXPECT_EQ(checksum(Describer::Method::kHandmade), 2215372942U);
  EXPECT_EQ(checksum(Describer::Method::kTrained),
            2349607564U);  // of the compiled model: changes when it is trained anew
}

class RefusedSubmap : public ::testing::Test {
 protected:
  void ExpectRefused(const submap::Submap& submap) {
    PlaceDescription description;
    description.descriptor.q.fill(42);
    const auto describer = std::make_unique<Describer>();
    EXPECT_EQ(describer->Describe(submap, &description), Status::kBadInput);
    EXPECT_THAT(description.descriptor.q, ::testing::Each(42));
    EXPECT_EQ(description.descriptor.scale, 0);
  }
  // Enough points spread over all three axes.
  submap::Submap& Sound(std::size_t points) {
    submap::Submap& submap = Scratch();
    Dice dice(5);
    for (std::size_t i = 0; i < points; ++i) {
      Push(submap, dice.Between(-30, 30), dice.Between(-30, 30), dice.Between(-2, 3));
    }
    return submap;
  }
};

TEST_F(RefusedSubmap, IsNotOneWithJustEnoughPoints) {
  (void)Describe(Sound(Describer::kMinPoints));
}

TEST_F(RefusedSubmap, HasTooFewPoints) {
  ExpectRefused(Scratch());
  ExpectRefused(Sound(Describer::kMinPoints - 1));
}

TEST_F(RefusedSubmap, HasTooFewPointsWithinReach) {
  submap::Submap& submap = Sound(1000);
  for (std::size_t i = 100; i < 1000; ++i) submap.points[i].x += 200;
  ExpectRefused(submap);
}

TEST_F(RefusedSubmap, HoldsAPointThatIsNoNumberOrTooFarAway) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity(), 1e30F, -2000.0F}) {
    for (float submap::SubmapPoint::*const axis :
         {&submap::SubmapPoint::x, &submap::SubmapPoint::y, &submap::SubmapPoint::z}) {
      submap::Submap& submap = Sound(1000);
      submap.points[777].*axis = bad;
      ExpectRefused(submap);
    }
  }
}

TEST_F(RefusedSubmap, LiesInOnePlaneHoweverTilted) {
  for (const float tilt : {0.0F, 0.3F, 20.0F}) {
    submap::Submap& submap = Sound(2000);
    for (submap::SubmapPoint& p : submap.points) {
      p.x /= 1 + tilt;
      p.z = tilt * p.x + 0.01F * p.z;
    }
    ExpectRefused(submap);
  }
}

TEST_F(RefusedSubmap, LiesOnOneLineOrInOnePoint) {
  for (const float length : {0.0F, 1.0F}) {
    submap::Submap& submap = Sound(2000);
    for (submap::SubmapPoint& p : submap.points) {
      p.y = 0.5F * p.x * length;
      p.z = 0.1F * p.x * length;
      p.x *= length;
    }
    ExpectRefused(submap);
  }
}

}  // namespace
}  // namespace mapweld::place
