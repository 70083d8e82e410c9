// SPDX-License-Identifier: Apache-2.0
// Rows to one row, channel by channel.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mapweld::nn {

// rows: [count][RowStride(channels)], count >= 1. out: RowStride(channels) bytes.
void MaxPool(const std::int8_t* rows, std::size_t count, std::size_t channels, std::int8_t* out);
// floor(sum / count + 1/2). sums: RowStride(channels) words of working memory. count <= 65536.
void MeanPool(const std::int8_t* rows, std::size_t count, std::size_t channels, std::int32_t* sums, std::int8_t* out);

}  // namespace mapweld::nn
