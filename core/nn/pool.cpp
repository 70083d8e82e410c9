// SPDX-License-Identifier: Apache-2.0
#include "core/nn/pool.hpp"

#include <algorithm>

#include "core/base/assert.hpp"
#include "core/nn/linear.hpp"

namespace mapweld::nn {

void MaxPool(const std::int8_t* rows, std::size_t count, std::size_t channels, std::int8_t* out) {
  MAPWELD_ASSERT(count > 0);
  const std::size_t stride = RowStride(channels);
  std::copy(rows, rows + stride, out);
  for (std::size_t m = 1; m < count; ++m) {
    for (std::size_t c = 0; c < stride; ++c) out[c] = std::max(out[c], rows[m * stride + c]);
  }
}

void MeanPool(const std::int8_t* rows, std::size_t count, std::size_t channels, std::int32_t* sums, std::int8_t* out) {
  MAPWELD_ASSERT(count > 0 && count <= 65536);
  const std::size_t stride = RowStride(channels);
  std::fill(sums, sums + stride, 0);
  for (std::size_t m = 0; m < count; ++m) {
    for (std::size_t c = 0; c < stride; ++c) sums[c] += rows[m * stride + c];
  }
  const auto n = static_cast<std::int32_t>(count);
  for (std::size_t c = 0; c < stride; ++c) {
    // floor((2 sum + n) / 2n), made positive first because division rounds towards zero
    out[c] = static_cast<std::int8_t>((2 * sums[c] + n + 256 * n) / (2 * n) - 128);
  }
}

}  // namespace mapweld::nn
