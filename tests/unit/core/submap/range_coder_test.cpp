// SPDX-License-Identifier: Apache-2.0
#include "core/submap/range_coder.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace mapweld::submap {
namespace {

TEST(RangeCoder, GivesBackEveryBit) {
  std::mt19937 rng(3);
  for (const double share : {0.5, 0.02, 0.999}) {
    std::bernoulli_distribution draw(share);
    std::vector<bool> bits(20000);
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = draw(rng);
    std::vector<std::uint8_t> bytes(8000);
    RangeEncoder encoder(bytes);
    BitModel model;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      encoder.Put(bits[i], &model);
      if (i % 7 == 0) encoder.PutEven(static_cast<std::uint32_t>(i % 16), 4);
    }
    bytes.resize(encoder.Finish());
    ASSERT_FALSE(encoder.failed());
    RangeDecoder decoder(bytes);
    model = {};
    for (std::size_t i = 0; i < bits.size(); ++i) {
      ASSERT_EQ(decoder.Get(&model), bits[i]) << i;
      if (i % 7 == 0) {
        ASSERT_EQ(decoder.GetEven(4), i % 16);
      }
    }
    EXPECT_FALSE(decoder.failed());
    EXPECT_EQ(decoder.read(), bytes.size());
  }
}

TEST(RangeCoder, ABitThatIsNearlyAlwaysTheSameCostsNearlyNothing) {
  std::vector<std::uint8_t> bytes(4000);
  RangeEncoder encoder(bytes);
  BitModel model;
  for (int i = 0; i < 20000; ++i) encoder.Put(i % 100 == 0, &model);
  EXPECT_LT(encoder.Finish(), 20000U / 8 / 8);
}

TEST(RangeCoder, SaysWhenTheBufferIsFull) {
  std::vector<std::uint8_t> bytes(10);
  RangeEncoder encoder(bytes);
  for (std::uint32_t i = 0; i < 100; ++i) encoder.PutEven(i % 256, 8);
  EXPECT_LE(encoder.Finish(), 10U);
  EXPECT_TRUE(encoder.failed());
}

}  // namespace
}  // namespace mapweld::submap
