// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/likeness.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tools/merge/simd.hpp"

namespace mapweld::merge {
namespace {

constexpr std::size_t kSample = 4096;  // entries; the error of the deviation is then 2 %

// Sum of one row, no entry counted as more than `most`; the same is added to the columns' sums.
MAPWELD_SIMD_FUNCTION(std::int64_t, SumRow,
                      (const std::int16_t* row, int cols, std::int16_t most, std::int32_t* col_sums), {
                        std::int32_t sum = 0;
                        for (int k = 0; k < cols; ++k) {
                          const std::int16_t value = std::min(row[k], most);
                          sum += value;
                          col_sums[k] += value;
                        }
                        return sum;
                      })

// to = clamp(128 - round(scale * (2 row[k] - row_mean - col_means[k]) / 2^15)).
MAPWELD_SIMD_FUNCTION(void, ToSteps,
                      (const std::int16_t* row, int cols, std::int32_t row_mean, const std::int32_t* col_means,
                       std::int32_t scale, std::int32_t offset, std::uint8_t* to),
                      {
                        for (int k = 0; k < cols; ++k) {
                          const std::int32_t z = 2 * row[k] - row_mean - col_means[k] - offset;
                          const std::int32_t bounded = std::clamp(z, -32767, 32767);
                          const std::int32_t steps = (bounded * scale + (1 << 14)) >> 15;
                          to[k] = static_cast<std::uint8_t>(std::clamp(Likeness::kZero - steps, 0, 255));
                        }
                      })

std::int32_t RoundedMean(std::int64_t sum, int n) {
  return static_cast<std::int32_t>(std::lround(static_cast<double>(sum) / n));
}

}  // namespace

std::vector<std::size_t> Scattered(std::size_t size, std::size_t count) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < std::min(size, count); ++i) out.push_back(size <= count ? i : i * 2654435769U % size);
  return out;
}

Spread RobustSpread(std::vector<int> values, double least) {
  if (values.empty()) return {0, least};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const int median = *middle;
  for (int& value : values) value = std::abs(value - median);
  std::nth_element(values.begin(), middle, values.end());
  constexpr double kMadToSigma = 1.4826;
  return {static_cast<double>(median), std::max(least, kMadToSigma * *middle)};
}

Likeness ComputeLikeness(const Cosines& cosines) {
  Likeness out{cosines.rows, cosines.cols, std::vector<std::uint8_t>(cosines.c.size())};
  if (cosines.c.empty()) return out;
  const auto row_of = [&](int i) { return cosines.c.data() + static_cast<std::ptrdiff_t>(i) * cosines.cols; };
  // Means, in which true matches count for no more than two deviations.
  const std::vector<std::size_t> sample = Scattered(cosines.c.size(), kSample);
  std::vector<int> values;
  for (const std::size_t i : sample) values.push_back(cosines.c[i]);
  const Spread raw = RobustSpread(std::move(values), 1);
  const auto most = static_cast<std::int16_t>(std::min(32767.0, raw.median + 2 * raw.sigma));
  std::vector<std::int32_t> row_mean;
  std::vector<std::int32_t> col_mean(static_cast<std::size_t>(cosines.cols), 0);
  for (int i = 0; i < cosines.rows; ++i) {
    row_mean.push_back(RoundedMean(SumRow(row_of(i), cosines.cols, most, col_mean.data()), cosines.cols));
  }
  for (std::int32_t& sum : col_mean) sum = RoundedMean(sum, cosines.rows);

  values.clear();
  for (const std::size_t i : sample) {
    const std::size_t row = i / static_cast<std::size_t>(cosines.cols);
    const std::size_t col = i % static_cast<std::size_t>(cosines.cols);
    values.push_back(2 * cosines.c[i] - row_mean[row] - col_mean[col]);
  }
  const Spread z = RobustSpread(std::move(values), 1);
  const auto scale = static_cast<std::int32_t>(std::clamp(std::lround(Likeness::kUnit * 32768 / z.sigma), 1L, 65535L));
  for (int i = 0; i < cosines.rows; ++i) {
    ToSteps(row_of(i), cosines.cols, row_mean[static_cast<std::size_t>(i)], col_mean.data(), scale,
            static_cast<std::int32_t>(z.median), out.d.data() + static_cast<std::ptrdiff_t>(i) * cosines.cols);
  }
  return out;
}

}  // namespace mapweld::merge
