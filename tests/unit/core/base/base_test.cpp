// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>

#include "core/base/crc32.hpp"
#include "core/base/fixed_vector.hpp"
#include "core/base/ring_buffer.hpp"
#include "core/base/voxel_key.hpp"

namespace mapweld {
namespace {

TEST(FixedVector, RefusesTheNewcomerWhenFullAndKeepsTheRest) {
  FixedVector<int, 3> v;
  for (int i = 0; i < 3; ++i) ASSERT_EQ(v.TryPush(i), Status::kOk);
  EXPECT_EQ(v.TryPush(9), Status::kFull);
  EXPECT_EQ(v.size(), 3U);
  EXPECT_EQ(v.back(), 2);
}

TEST(FixedVector, CopiesOnlyWhatItHolds) {
  FixedVector<int, 8> a;
  ASSERT_EQ(a.TryPush(7), Status::kOk);
  FixedVector<int, 8> b;
  for (int i = 0; i < 5; ++i) ASSERT_EQ(b.TryPush(i), Status::kOk);
  b = a;
  EXPECT_EQ(b.size(), 1U);
  EXPECT_EQ(b[0], 7);
}

TEST(FixedVectorDeathTest, AnIndexBeyondTheSizeIsOurBug) {
  FixedVector<int, 2> v;
  EXPECT_DEATH((void)v[0], "");
}

TEST(RingBuffer, DropsTheOldestWhenFullAndCounts) {
  RingBuffer<int, 3> ring;
  for (int i = 0; i < 5; ++i) ring.Push(i);
  EXPECT_EQ(ring.size(), 3U);
  EXPECT_EQ(ring.front(), 2);
  EXPECT_EQ(ring.back(), 4);
  EXPECT_EQ(ring.dropped(), 2U);
}

TEST(RingBuffer, StaysInOrderAcrossTheWrap) {
  RingBuffer<int, 4> ring;
  int next_in = 0;
  int next_out = 0;
  for (int round = 0; round < 100; ++round) {
    for (int i = 0; i < 3; ++i) ring.Push(next_in++);
    for (int i = 0; i < 3; ++i) {
      ASSERT_EQ(ring.front(), next_out++);
      ring.PopFront();
    }
  }
  EXPECT_EQ(ring.dropped(), 0U);
}

TEST(Crc32, GivesTheCheckValueOfTheStandard) {
  const char text[] = "123456789";
  std::uint8_t bytes[9];
  std::memcpy(bytes, text, 9);
  EXPECT_EQ(Crc32(bytes), 0xCBF43926U);
  EXPECT_EQ(Crc32(std::span(bytes).subspan(4), Crc32(std::span(bytes).first(4))), 0xCBF43926U);
}

TEST(VoxelKey, UnpacksWhatItPackedAndIsNeverZero) {
  for (const Cell cell : {Cell{0, 0, 0}, Cell{-1, 2, -3}, Cell{kCellLimit - 1, -kCellLimit, 7},
                          Cell{-kCellLimit, -kCellLimit, -kCellLimit}}) {
    const std::uint64_t key = PackCell(cell);
    EXPECT_NE(key, 0U);
    const Cell back = UnpackCell(key);
    EXPECT_EQ(back.x, cell.x);
    EXPECT_EQ(back.y, cell.y);
    EXPECT_EQ(back.z, cell.z);
  }
}

}  // namespace
}  // namespace mapweld
