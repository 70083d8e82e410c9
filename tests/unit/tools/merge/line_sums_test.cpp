// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/line_sums.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <tuple>
#include <vector>

namespace mapweld::merge {
namespace {

struct Image {
  int rows = 0;
  int cols = 0;
  std::vector<std::uint8_t> d;
  [[nodiscard]] int at(int row, int col) const { return d[static_cast<std::size_t>(row * cols + col)]; }
};

Image RandomImage(int rows, int cols) {
  std::mt19937 random(7);
  Image out{rows, cols, std::vector<std::uint8_t>(static_cast<std::size_t>(rows * cols))};
  for (std::uint8_t& d : out.d) d = static_cast<std::uint8_t>(random());
  return out;
}

// Every sum added up on its own.
int DirectLeast(const Image& image, int row, int col, int length, int row_step, bool reverse) {
  int least = LineSums::kNoLine;
  if (row < length - 1) return least;
  for (const double speed : kLineSpeeds) {
    const auto shift = [&](int r) { return (reverse ? -1 : 1) * static_cast<int>(std::floor(speed * row_step * r)); };
    int sum = 0;
    bool inside = true;
    for (int r = row - length + 1; r <= row && inside; ++r) {
      const int at = col - shift(row) + shift(r);
      inside = at >= 0 && at < image.cols;
      if (inside) sum += image.at(r, at);
    }
    if (inside) least = std::min(least, sum);
  }
  return least;
}

class LineSumsAgainstDirectSums : public ::testing::TestWithParam<std::tuple<int, int, bool>> {};

TEST_P(LineSumsAgainstDirectSums, AreBitEqual) {
  const auto [length, row_step, reverse] = GetParam();
  const Image image = RandomImage(140, 171);
  LineSums lines(image.cols, length, row_step, reverse);
  int with_a_line = 0;
  for (int row = 0; row < image.rows; ++row) {
    const int least = lines.Add(image.d.data() + row * image.cols);
    int expected_least = LineSums::kNoLine;
    for (int col = 0; col < image.cols; ++col) {
      const int expected = DirectLeast(image, row, col, length, row_step, reverse);
      ASSERT_EQ(lines.least()[static_cast<std::size_t>(col)], expected) << "row " << row << ", col " << col;
      expected_least = std::min(expected_least, expected);
      with_a_line += expected != LineSums::kNoLine ? 1 : 0;
    }
    ASSERT_EQ(least, expected_least);
  }
  EXPECT_GT(with_a_line, 0);
}

INSTANTIATE_TEST_SUITE_P(Lengths, LineSumsAgainstDirectSums,
                         ::testing::Combine(::testing::Values(1, 4, 10, 33, 100), ::testing::Values(1),
                                            ::testing::Bool()));
INSTANTIATE_TEST_SUITE_P(Steps, LineSumsAgainstDirectSums,
                         ::testing::Combine(::testing::Values(4, 16), ::testing::Values(2, 4), ::testing::Bool()));

TEST(LineSums, TakeAMatrixTooSmallForALine) {
  const Image image = RandomImage(3, 2);
  LineSums lines(image.cols, 16, 1, false);
  for (int row = 0; row < image.rows; ++row) EXPECT_EQ(lines.Add(image.d.data() + row * 2), LineSums::kNoLine);
}

}  // namespace
}  // namespace mapweld::merge
