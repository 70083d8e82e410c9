// SPDX-License-Identifier: Apache-2.0
// Cosines made comparable: each entry against its row and its column (a keyframe that resembles everything says
// nothing), in units of the matrix's own robust standard deviation.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/merge/difference.hpp"

namespace mapweld::merge {

struct Likeness {
  static constexpr int kZero = 128;  // as alike as usual
  static constexpr int kUnit = 16;   // steps per standard deviation; 0 is 8 deviations more alike than usual
  int rows = 0;
  int cols = 0;
  std::vector<std::uint8_t> d;  // row-major, small = alike
  [[nodiscard]] const std::uint8_t* row(int i) const { return d.data() + static_cast<std::ptrdiff_t>(i) * cols; }
  // Standard deviations above the usual.
  [[nodiscard]] double Score(int row_index, int col) const {
    return static_cast<double>(kZero - row(row_index)[col]) / kUnit;
  }
};

// Integer arithmetic but for three numbers of the whole matrix. About 1 ns per entry.
Likeness ComputeLikeness(const Cosines& cosines);

// Median and robust standard deviation of the numbers, at least `least`. Empty: 0 and least.
struct Spread {
  double median = 0;
  double sigma = 0;
};
Spread RobustSpread(std::vector<int> values, double least);

// `count` entries of 0..size-1, evenly scattered: multiples of the golden ratio, so that no period of the matrix is
// met.
std::vector<std::size_t> Scattered(std::size_t size, std::size_t count);

}  // namespace mapweld::merge
