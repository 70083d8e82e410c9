// SPDX-License-Identifier: Apache-2.0
// What the published descriptors promise, on a street made of walls: the same place from another heading is near,
// another place is far.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "tools/baselines/scan_context.hpp"
#include "tools/describe/variants.hpp"

namespace mapweld::baselines {
namespace {

using describe::PlaceMethod;

// 25 walls at random places, seen from `turn` and `aside_m` to the left.
std::unique_ptr<submap::Submap> Street(unsigned seed, double turn, double aside_m) {
  auto submap = std::make_unique<submap::Submap>();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> at(-45, 45);
  std::uniform_real_distribution<double> share(0, 1);
  for (int wall = 0; wall < 25; ++wall) {
    const double x = at(random);
    const double y = at(random);
    const double heading = share(random) * std::numbers::pi;
    const double length = 5 + 15 * share(random);
    const double height = 2 + 8 * share(random);
    for (double s = 0; s < length; s += 0.5) {
      for (double z = -1.5; z < height; z += 0.5) {
        const double px = x + s * std::cos(heading);
        const double py = y + s * std::sin(heading) - aside_m;
        const double qx = std::cos(turn) * px + std::sin(turn) * py;
        const double qy = -std::sin(turn) * px + std::cos(turn) * py;
        if (std::hypot(qx, qy) > 50) continue;
        EXPECT_EQ(submap->points.TryPush({static_cast<float>(qx), static_cast<float>(qy), static_cast<float>(z), 1, 0}),
                  Status::kOk);
      }
    }
  }
  return submap;
}

class Baseline : public testing::TestWithParam<std::string> {
 protected:
  PlaceMethod::Features Of(const submap::Submap& submap) {
    place::PlaceDescription place;
    EXPECT_EQ(method_->Describe(submap, &place), Status::kOk);
    return method_->Prepare(place);
  }
  std::unique_ptr<PlaceMethod> method_ = describe::MakeVariant(GetParam());
};

TEST_P(Baseline, IsAtNoDistanceFromItself) {
  const auto a = Of(*Street(1, 0, 0));
  EXPECT_NEAR(method_->Distance(a, a), 0, 1e-5);
}

TEST_P(Baseline, KnowsAPlaceFromAnotherHeadingAmongTen) {
  const auto query = Of(*Street(0, 2.1, 0.5));
  const float same = method_->Distance(query, Of(*Street(0, 0, 0)));
  for (unsigned other = 1; other < 10; ++other) {
    EXPECT_LT(same, method_->Distance(query, Of(*Street(other, 0, 0)))) << other;
  }
}

TEST_P(Baseline, RefusesWhatIsNoPlace) {
  place::PlaceDescription place;
  place.descriptor.scale = 7;
  const auto empty = std::make_unique<submap::Submap>();
  EXPECT_NE(method_->Describe(*empty, &place), Status::kOk);
  auto broken = Street(1, 0, 0);
  broken->points[100].z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(method_->Describe(*broken, &place), Status::kOk);
  EXPECT_EQ(place.descriptor.scale, 7);
}

INSTANTIATE_TEST_SUITE_P(All, Baseline, testing::Values("handmade", "scan-context", "solid", "m2dp"),
                         [](const auto& named) {
                           std::string name = named.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(ScanContext, KeepsTheHeightOfTheHighestPointOfEachCell) {
  auto submap = std::make_unique<submap::Submap>();
  // 20 cells to be a place, each in a ring of its own along +x: sector 0.
  for (int ring = 0; ring < 20; ++ring) {
    const float x = 2.5F * static_cast<float>(ring) + 1;
    ASSERT_EQ(submap->points.TryPush({x, 0.01F, -1, 1, 0}), Status::kOk);
  }
  ASSERT_EQ(submap->points.TryPush({1, 0.01F, 10.7F, 1, 0}), Status::kOk);  // 12.7 m over the ground
  place::PlaceDescription place;
  ScanContext method;
  ASSERT_EQ(method.Describe(*submap, &place), Status::kOk);
  EXPECT_FLOAT_EQ(place.descriptor.scale, 0.1F);
  EXPECT_EQ(place.descriptor.q[0], 127);
  EXPECT_EQ(place.descriptor.q[1], 10);  // 1 m
  EXPECT_EQ(place.descriptor.q[19], 10);
  EXPECT_EQ(place.descriptor.q[20], 0);  // the next sector
}

TEST(ScanContext, IsTheSameAfterWholeSectorsOfTurn) {
  ScanContext method;
  place::PlaceDescription a;
  place::PlaceDescription b;
  ASSERT_EQ(method.Describe(*Street(3, 0, 0), &a), Status::kOk);
  ASSERT_EQ(method.Describe(*Street(3, std::numbers::pi / 2, 0), &b), Status::kOk);
  EXPECT_NEAR(method.Distance(method.Prepare(a), method.Prepare(b)), 0, 0.03);
}

}  // namespace
}  // namespace mapweld::baselines
