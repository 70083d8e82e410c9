// SPDX-License-Identifier: Apache-2.0
// Sums along lines of a likeness matrix, row by row: SeqSLAM (Milford, Wyeth, ICRA 2012) with running sums, so that the
// cost per entry does not depend on the length of the lines.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace mapweld::merge {

// Columns that a line moves per row, of the matrix of all keyframes.
inline constexpr std::array<double, 5> kLineSpeeds = {1.0, 0.9, 1.1, 0.8, 1.25};

class LineSums {
 public:
  static constexpr std::uint16_t kNoLine = 65535;
  static constexpr int kMaxLength = 256;  // sums stay below 2^16

  // Lines over `length` rows, 1..kMaxLength. row_step: keyframes from one row to the next. reverse: columns fall.
  LineSums(int cols, int length, int row_step, bool reverse);

  // Adds the next row of the matrix. least()[k] is then the least sum of all lines that end in this row at column k and
  // lie in the matrix with all their length, kNoLine where there is none. Gives the least of least(). For each of five
  // speeds one addition, one subtraction and one comparison an entry.
  std::uint16_t Add(const std::uint8_t* row);
  [[nodiscard]] std::span<const std::uint16_t> least() const { return least_; }

  // Columns from the first row to row `rows` on a line of speed kLineSpeeds[speed].
  [[nodiscard]] int Shift(int speed, int rows) const;

 private:
  std::uint16_t* Ring(int row);

  int cols_;
  int length_;
  int row_step_;
  bool reverse_;
  int margin_;  // zeros on both sides of a row: what lines find outside
  int row_ = 0;
  std::vector<std::uint16_t> ring_;                                      // the last length + 1 rows
  std::array<std::vector<std::uint16_t>, 2 * kLineSpeeds.size()> sums_;  // before and after the row, by turns
  std::vector<std::uint16_t> least_;
};

}  // namespace mapweld::merge
