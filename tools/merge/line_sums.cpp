// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/line_sums.hpp"

#include <algorithm>
#include <cmath>

#include "tools/merge/simd.hpp"

namespace mapweld::merge {
namespace {

// One row of one bundle: after = before + newest - oldest; the least of it in [begin, end) goes to `least`.
MAPWELD_SIMD_FUNCTION(void, Advance,
                      (const std::uint16_t* __restrict before, const std::uint16_t* __restrict newest,
                       const std::uint16_t* __restrict oldest, int begin, int end, std::uint16_t* __restrict after,
                       std::uint16_t* __restrict least),
                      {
                        for (int k = begin; k < end; ++k) {
                          const auto sum = static_cast<std::uint16_t>(before[k] + newest[k] - oldest[k]);
                          after[k] = sum;
                          least[k] = std::min(least[k], sum);
                        }
                      })

void AdvanceBlind(const std::uint16_t* before, const std::uint16_t* newest, const std::uint16_t* oldest, int begin,
                  int end, std::uint16_t* after) {
  for (int k = begin; k < end; ++k) after[k] = static_cast<std::uint16_t>(before[k] + newest[k] - oldest[k]);
}

MAPWELD_SIMD_FUNCTION(std::uint16_t, LeastOf, (const std::uint16_t* values, int n), {
  std::uint16_t least = LineSums::kNoLine;
  for (int k = 0; k < n; ++k) least = std::min(least, values[k]);
  return least;
})

}  // namespace

LineSums::LineSums(int cols, int length, int row_step, bool reverse)
    : cols_(cols), length_(length), row_step_(row_step), reverse_(reverse) {
  const double fastest = *std::max_element(kLineSpeeds.begin(), kLineSpeeds.end());
  margin_ = static_cast<int>(std::ceil(fastest * row_step * (length + 1))) + 1;
  const auto width = static_cast<std::size_t>(cols + 2 * margin_);
  ring_.assign(width * static_cast<std::size_t>(length + 1), 0);
  for (auto& sums : sums_) sums.assign(width, 0);
  least_.assign(static_cast<std::size_t>(cols), kNoLine);
}

int LineSums::Shift(int speed, int rows) const {
  const auto columns = static_cast<int>(std::floor(kLineSpeeds[static_cast<std::size_t>(speed)] * row_step_ * rows));
  return reverse_ ? -columns : columns;
}

std::uint16_t* LineSums::Ring(int row) {
  return ring_.data() + static_cast<std::ptrdiff_t>(row % (length_ + 1)) * (cols_ + 2 * margin_) + margin_;
}

std::uint16_t LineSums::Add(const std::uint8_t* row) {
  std::uint16_t* newest = Ring(row_);
  std::copy_n(row, cols_, newest);
  std::fill(least_.begin(), least_.end(), kNoLine);
  // Before row length + 1 the ring's next place is still empty: nothing to take off.
  const std::uint16_t* oldest = Ring(row_ + 1);
  for (std::size_t v = 0; v < kLineSpeeds.size(); ++v) {
    const int speed = static_cast<int>(v);
    const int last_row = Shift(speed, row_);
    const int moved = last_row - Shift(speed, std::max(0, row_ - 1));
    const int moved_all = last_row - Shift(speed, std::max(0, row_ - length_));
    const std::uint16_t* before = sums_[2 * v + static_cast<std::size_t>(row_ % 2)].data() + margin_ - moved;
    std::uint16_t* after = sums_[2 * v + static_cast<std::size_t>((row_ + 1) % 2)].data() + margin_;
    // Whole lines only.
    int begin = cols_;
    int end = cols_;
    if (row_ >= length_ - 1) {
      const int reach = last_row - Shift(speed, row_ - length_ + 1);
      begin = std::clamp(reach, 0, cols_);
      end = std::clamp(cols_ + reach, 0, cols_);
    }
    AdvanceBlind(before, newest, oldest - moved_all, 0, begin, after);
    Advance(before, newest, oldest - moved_all, begin, end, after, least_.data());
    AdvanceBlind(before, newest, oldest - moved_all, end, cols_, after);
  }
  ++row_;
  return LeastOf(least_.data(), cols_);
}

}  // namespace mapweld::merge
