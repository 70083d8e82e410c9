// SPDX-License-Identifier: Apache-2.0
#include "tools/io/lzf.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace mapweld::io {
namespace {

std::string Bytes(std::initializer_list<int> values) {
  std::string bytes;
  for (const int v : values) bytes.push_back(static_cast<char>(v));
  return bytes;
}

TEST(Lzf, CopiesLiterals) {
  std::string out;
  ASSERT_TRUE(DecompressLzf(Bytes({2, 'a', 'b', 'c'}), 3, &out));
  EXPECT_EQ(out, "abc");
}

TEST(Lzf, CopiesFromBehindAlsoWhenTheCopyOverlapsItself) {
  std::string out;
  // "ab", then 5 bytes from distance 2.
  ASSERT_TRUE(DecompressLzf(Bytes({1, 'a', 'b', 3 << 5, 1}), 7, &out));
  EXPECT_EQ(out, "abababa");
  // "x", then 7 + 200 + 2 bytes from distance 1.
  ASSERT_TRUE(DecompressLzf(Bytes({0, 'x', 7 << 5, 200, 0}), 210, &out));
  EXPECT_EQ(out, std::string(210, 'x'));
}

TEST(Lzf, UsesAllThirteenBitsOfTheDistance) {
  std::string block;
  for (int i = 0; i < 10; ++i) block += Bytes({31}) + std::string(32, static_cast<char>('a' + i));
  block += Bytes({(1 << 5) | 1, 0x3F});  // 3 bytes from distance 256 + 63 + 1 = 320, the very start
  std::string out;
  ASSERT_TRUE(DecompressLzf(block, 323, &out));
  EXPECT_EQ(out.substr(320), "aaa");
}

TEST(Lzf, RefusesEveryTruncation) {
  const std::string block = Bytes({1, 'a', 'b', 7 << 5, 4, 1, 0, 'z'});
  std::string out;
  ASSERT_TRUE(DecompressLzf(block, 16, &out));
  for (std::size_t size = 0; size < block.size(); ++size) {
    EXPECT_FALSE(DecompressLzf(block.substr(0, size), 16, &out)) << size;
  }
}

TEST(Lzf, RefusesReachingBeforeTheStartAndWrongSizes) {
  std::string out;
  EXPECT_FALSE(DecompressLzf(Bytes({0, 'a', 1 << 5, 1}), 4, &out));
  EXPECT_FALSE(DecompressLzf(Bytes({2, 'a', 'b', 'c'}), 2, &out));
  EXPECT_FALSE(DecompressLzf(Bytes({2, 'a', 'b', 'c'}), 4, &out));
  EXPECT_FALSE(DecompressLzf(Bytes({2, 'a', 'b', 'c'}), SIZE_MAX, &out)) << "a forged size was believed";
}

TEST(Lzf, SurvivesRandomBytes) {
  std::mt19937 random(7);
  std::string out;
  for (int trial = 0; trial < 20000; ++trial) {
    std::string block(random() % 40, '\0');
    for (char& c : block) c = static_cast<char>(random());
    (void)DecompressLzf(block, random() % 300, &out);
    ASSERT_LE(out.size(), 300U);
  }
}

}  // namespace
}  // namespace mapweld::io
