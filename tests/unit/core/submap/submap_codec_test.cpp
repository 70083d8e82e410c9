// SPDX-License-Identifier: Apache-2.0
#include "core/submap/submap_codec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "core/submap/rolling_map.hpp"

namespace mapweld::submap {
namespace {

std::unique_ptr<Submap> RandomSubmap(int n) {
  auto map = std::make_unique<RollingMap>();
  std::mt19937 rng(1);
  std::normal_distribution<float> normal(0, 12);
  for (int i = 0; i < n; ++i) (void)map->Insert({normal(rng), normal(rng), 0.2F * normal(rng)}, 0);
  auto submap = std::make_unique<Submap>();
  submap->keyframe = 17;
  submap->t = {123456789012345};
  submap->flushed = true;
  EXPECT_EQ(map->Extract({}, 0, submap.get()), Status::kOk);
  return submap;
}

std::vector<std::uint8_t> Encode(const Submap& submap) {
  std::vector<std::uint8_t> bytes(kCap.submap_encoded_bytes);
  const auto n = std::make_unique<SubmapEncoder>()->Encode(submap, bytes);
  EXPECT_TRUE(n.ok());
  bytes.resize(n.value());
  return bytes;
}

TEST(SubmapCodec, DecodesToWithinHalfAGridStep) {
  const auto submap = RandomSubmap(20000);
  const auto bytes = Encode(*submap);
  auto back = std::make_unique<Submap>();
  ASSERT_EQ(DecodeSubmap(bytes, back.get()), Status::kOk);
  EXPECT_EQ(back->keyframe, 17);
  EXPECT_EQ(back->t.ns, 123456789012345);
  EXPECT_TRUE(back->flushed);
  ASSERT_EQ(back->points.size(), submap->points.size());
  for (std::size_t i = 0; i < back->points.size(); ++i) {
    EXPECT_LE(std::abs(back->points[i].x - submap->points[i].x), 0.5 / 32 + 1e-5);
    EXPECT_LE(std::abs(back->points[i].y - submap->points[i].y), 0.5 / 32 + 1e-5);
    EXPECT_LE(std::abs(back->points[i].z - submap->points[i].z), 0.5 / 32 + 1e-5);
  }
  EXPECT_LT(bytes.size(), 4 * submap->points.size() + 64);
}

TEST(SubmapCodec, EncodingADecodedSubmapGivesTheSameBytes) {
  const auto bytes = Encode(*RandomSubmap(3000));
  auto back = std::make_unique<Submap>();
  ASSERT_EQ(DecodeSubmap(bytes, back.get()), Status::kOk);
  EXPECT_EQ(Encode(*back), bytes);
}

TEST(SubmapCodec, EncodingInPartsGivesTheSameBytes) {
  const auto submap = RandomSubmap(3000);
  std::vector<std::uint8_t> bytes(kCap.submap_encoded_bytes);
  auto encoder = std::make_unique<SubmapEncoder>();
  ASSERT_EQ(encoder->Begin(*submap, bytes), Status::kOk);
  int calls = 1;
  Result<std::size_t> size = encoder->Continue(*submap, 500);
  for (; size.status() == Status::kNotReady; ++calls) size = encoder->Continue(*submap, 500);
  ASSERT_TRUE(size.ok());
  bytes.resize(size.value());
  EXPECT_EQ(bytes, Encode(*submap));
  EXPECT_NEAR(calls, static_cast<double>(submap->points.size()) / 500, 2);
}

TEST(SubmapCodec, RefusesEveryTruncation) {
  const auto bytes = Encode(*RandomSubmap(100));
  auto back = std::make_unique<Submap>();
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_NE(DecodeSubmap(std::span(bytes).first(n), back.get()), Status::kOk) << n;
  }
}

TEST(SubmapCodec, RefusesEverySingleFlippedBit) {
  auto bytes = Encode(*RandomSubmap(100));
  auto back = std::make_unique<Submap>();
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_NE(DecodeSubmap(bytes, back.get()), Status::kOk) << bit;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1U << (bit % 8)));
  }
}

TEST(SubmapCodec, SaysWhenTheBufferIsTooSmallOrAPointTooFar) {
  const auto submap = RandomSubmap(100);
  std::vector<std::uint8_t> bytes(50);
  EXPECT_EQ(std::make_unique<SubmapEncoder>()->Encode(*submap, bytes).status(), Status::kFull);
  bytes.resize(kCap.submap_encoded_bytes);
  submap->points[0].x = 80;
  EXPECT_EQ(std::make_unique<SubmapEncoder>()->Encode(*submap, bytes).status(), Status::kOutOfRange);
  submap->points[0].x = NAN;
  EXPECT_EQ(std::make_unique<SubmapEncoder>()->Encode(*submap, bytes).status(), Status::kOutOfRange);
}

TEST(SubmapCodec, AnEmptySubmapIsFine) {
  const auto submap = std::make_unique<Submap>();
  const auto bytes = Encode(*submap);
  auto back = std::make_unique<Submap>();
  EXPECT_EQ(DecodeSubmap(bytes, back.get()), Status::kOk);
  EXPECT_TRUE(back->points.empty());
}

}  // namespace
}  // namespace mapweld::submap
