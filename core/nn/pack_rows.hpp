// SPDX-License-Identifier: Apache-2.0
// A block of rows laid out as the weights of a layer whose inputs are the rows, so that the linear kernel can sum over
// rows.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/nn/linear.hpp"

namespace mapweld::nn {

inline constexpr std::size_t kPackedRows = 64;
constexpr std::size_t PackedRowsBytes(std::size_t channels) {
  return PackedBytes(channels, kPackedRows);
}

// out[c / 8][m / 4][c % 8][m % 4] = rows[m][c]; 0 where m >= count or c >= channels. count <= kPackedRows.
using PackRowsFunction = void (*)(const std::int8_t* rows, std::size_t count, std::size_t channels, std::int8_t* out);
void PackRowsPortable(const std::int8_t* rows, std::size_t count, std::size_t channels, std::int8_t* out);

}  // namespace mapweld::nn
