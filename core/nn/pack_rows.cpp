// SPDX-License-Identifier: Apache-2.0
#include "core/nn/pack_rows.hpp"

namespace mapweld::nn {

void PackRowsPortable(const std::int8_t* rows, std::size_t count, std::size_t channels, std::int8_t* out) {
  for (std::size_t first_c = 0; first_c < channels; first_c += kOutputsPerBlock) {
    for (std::size_t first_m = 0; first_m < kPackedRows; first_m += kInputsPerGroup) {
      for (std::size_t c = first_c; c < first_c + kOutputsPerBlock; ++c) {
        for (std::size_t m = first_m; m < first_m + kInputsPerGroup; ++m) {
          *out++ = m < count && c < channels ? rows[m * RowStride(channels) + c] : std::int8_t{0};
        }
      }
    }
  }
}

}  // namespace mapweld::nn
