// SPDX-License-Identifier: Apache-2.0
#include "core/nn/neon.hpp"

#if defined(__aarch64__)
#include <arm_neon.h>

namespace mapweld::nn {

// Eight channels of four rows at a time; other sizes take the plain way.
void PackRowsNeon(const std::int8_t* rows, std::size_t count, std::size_t channels, std::int8_t* out) {
  if (count != kPackedRows || channels % kOutputsPerBlock != 0) return PackRowsPortable(rows, count, channels, out);
  for (std::size_t c = 0; c < channels; c += kOutputsPerBlock) {
    for (std::size_t m = 0; m < kPackedRows; m += 4, out += 32) {
      const std::int8_t* row = rows + m * channels + c;
      vst4_s8(out, int8x8x4_t{{vld1_s8(row), vld1_s8(row + channels), vld1_s8(row + 2 * channels),
                               vld1_s8(row + 3 * channels)}});
    }
  }
}

}  // namespace mapweld::nn
#endif
