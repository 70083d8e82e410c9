// SPDX-License-Identifier: Apache-2.0
#include "core/place/descriptor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/unit/core/place/made_up_town.hpp"

namespace mapweld::place {
namespace {

PlaceDescriptor Random(std::uint64_t seed) {
  testing::Dice dice(seed);
  PlaceDescriptor d;
  for (std::int8_t& q : d.q) q = static_cast<std::int8_t>(dice.Between(-127, 127));
  d.scale = 0.01F;
  return d;
}

TEST(CosineDistance, IsExactlyZeroBetweenEqualDescriptors) {
  for (std::uint64_t seed = 1; seed < 50; ++seed) EXPECT_EQ(CosineDistance(Random(seed), Random(seed)), 0);
}

TEST(CosineDistance, IsTwoBetweenOppositeDescriptors) {
  const PlaceDescriptor a = Random(1);
  PlaceDescriptor b = a;
  for (std::int8_t& q : b.q) q = static_cast<std::int8_t>(-q);
  EXPECT_EQ(CosineDistance(a, b), 2);
}

TEST(CosineDistance, IsOneBetweenDescriptorsAtRightAngles) {
  PlaceDescriptor a;
  PlaceDescriptor b;
  for (std::size_t i = 0; i < a.q.size(); ++i) (i % 2 == 0 ? a : b).q[i] = 100;
  EXPECT_EQ(CosineDistance(a, b), 1);
}

TEST(CosineDistance, AgreesWithTheFormulaInDoublePrecision) {
  const PlaceDescriptor a = Random(3);
  const PlaceDescriptor b = Random(4);
  double dot = 0;
  double aa = 0;
  double bb = 0;
  for (std::size_t i = 0; i < a.q.size(); ++i) {
    dot += static_cast<double>(a.q[i]) * b.q[i];
    aa += static_cast<double>(a.q[i]) * a.q[i];
    bb += static_cast<double>(b.q[i]) * b.q[i];
  }
  EXPECT_NEAR(CosineDistance(a, b), 1 - dot / std::sqrt(aa * bb), 1e-6);
}

TEST(CosineDistance, IsSymmetric) {
  for (std::uint64_t seed = 1; seed < 50; ++seed) {
    EXPECT_EQ(CosineDistance(Random(seed), Random(seed + 100)), CosineDistance(Random(seed + 100), Random(seed)));
  }
}

TEST(CosineDistance, DoesNotDependOnTheScales) {
  const PlaceDescriptor a = Random(5);
  PlaceDescriptor b = Random(6);
  const float before = CosineDistance(a, b);
  b.scale = 123;
  EXPECT_EQ(CosineDistance(a, b), before);
}

TEST(CosineDistance, CallsADescriptorOfZerosUnlikeEverything) {
  const PlaceDescriptor nothing;
  EXPECT_EQ(CosineDistance(nothing, nothing), 1);
  EXPECT_EQ(CosineDistance(nothing, Random(7)), 1);
  EXPECT_EQ(CosineDistance(Random(7), nothing), 1);
}

TEST(CosineDistance, IsNeverNanWhateverTheBytes) {
  PlaceDescriptor lowest;
  lowest.q.fill(-128);
  lowest.scale = std::numeric_limits<float>::quiet_NaN();
  PlaceDescriptor one;
  one.q[0] = 1;
  EXPECT_EQ(CosineDistance(lowest, lowest), 0);
  EXPECT_NEAR(CosineDistance(lowest, one), 1 + 1.0F / 32, 1e-6F);
}

}  // namespace
}  // namespace mapweld::place
