// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/receiver.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {
namespace {

const LidarModel kVlp16 = LidarByName("vlp16");

// Of 2000 shots at this distance, those that come back from there.
double DetectedShare(Surface surface, double distance_m, double cos_incidence, const Weather& weather = {}) {
  const Receiver receiver(kVlp16, weather);
  int seen = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const float d = receiver.Detect(surface, 5, distance_m, cos_incidence, Hash(1, i)).distance_m;
    seen += std::abs(static_cast<double>(d) - distance_m) < 0.5 ? 1 : 0;
  }
  return seen / 2000.0;
}

TEST(Receiver, LosesMoreReturnsFarAwayAndAtGrazingIncidence) {
  EXPECT_GT(DetectedShare(Surface::kWall, 10, 1), 0.99);
  EXPECT_LT(DetectedShare(Surface::kWall, 10, 1), 1.0);
  EXPECT_GT(DetectedShare(Surface::kRoad, 7, 0.25), 0.98);
  EXPECT_LT(DetectedShare(Surface::kRoad, 60, 0.03), 0.2);
  EXPECT_GT(DetectedShare(Surface::kWall, 60, 0.9), DetectedShare(Surface::kWall, 95, 0.9));
  EXPECT_LT(DetectedShare(Surface::kGlass, 40, 0.5), DetectedShare(Surface::kWall, 40, 0.5));
}

TEST(Receiver, MeasuresRangeWithTwoCentimetresOfNoiseInWholeSteps) {
  const Receiver receiver(kVlp16, {});
  double sum = 0;
  double squares = 0;
  int n = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const LidarReturn r = receiver.Detect(Surface::kWall, 5, 20, 1, Hash(2, i));
    if (r.distance_m <= 0) continue;
    const auto d = static_cast<double>(r.distance_m);
    sum += d - 20;
    squares += (d - 20) * (d - 20);
    ++n;
    ASSERT_NEAR(d / 0.002, std::round(d / 0.002), 1e-2);
    ASSERT_GE(r.reflectivity, 1);
    ASSERT_LE(r.reflectivity, 100);
  }
  EXPECT_NEAR(sum / n, 0, 0.0006);
  EXPECT_NEAR(std::sqrt(squares / n), 0.02, 0.0005);
}

TEST(Receiver, GetsIntoAHedgeBeforeItComesBack) {
  const Receiver receiver(kVlp16, {});
  double sum = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    sum += static_cast<double>(receiver.Detect(Surface::kHedge, 5, 10, 1, Hash(3, i)).distance_m);
  }
  EXPECT_NEAR(sum / 2000, 10.09, 0.05);
}

TEST(Receiver, SeesLessInRainAndFogAndNowAndThenADrop) {
  const Weather rain{20, 0};
  const Weather fog{0, 100};
  EXPECT_LT(DetectedShare(Surface::kWall, 60, 0.9, rain), DetectedShare(Surface::kWall, 60, 0.9));
  EXPECT_LT(DetectedShare(Surface::kWall, 60, 0.9, fog), 0.5 * DetectedShare(Surface::kWall, 60, 0.9));
  const Receiver in_rain(kVlp16, rain);
  const Receiver in_the_dry(kVlp16, {});
  int drops = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const LidarReturn r = in_rain.DetectAir(100, Hash(4, i));
    drops += r.distance_m > 0 ? 1 : 0;
    EXPECT_LT(r.distance_m, 16);
    EXPECT_EQ(in_the_dry.DetectAir(100, Hash(4, i)).distance_m, 0);
  }
  EXPECT_GT(drops, 20);
  EXPECT_LT(drops, 1000);
}

}  // namespace
}  // namespace mapweld::sim
