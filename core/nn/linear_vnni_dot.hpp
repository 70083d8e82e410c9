// SPDX-License-Identifier: Apache-2.0
// The tile of a processor that multiplies bytes and adds four products to a 32-bit sum in one instruction, which comes
// in two codings. Include after linear_tiles_x86.hpp. Instruction::Add(sum, x, w): x without sign, w with.
#pragma once

namespace mapweld::nn {
namespace {

template <class Instruction>
struct VnniDot {
  static constexpr bool kUsesNarrow = false;

  // x without sign: as it is after a ReLU, else its magnitude, with the signs moved to the weights.
  template <std::size_t R, bool kNarrow, bool kSigned>
  MAPWELD_TILE_INLINE static void Add(Tile<R>* tile, const std::int8_t* w0, const std::int8_t* w1,
                                      const std::int8_t* row, std::size_t stride, std::size_t groups) {
    for (std::size_t g = 0; g < groups; ++g) {
      const __m256i first = Load(w0 + kGroupBytes * g), second = Load(w1 + kGroupBytes * g);
      for (std::size_t r = 0; r < R; ++r) {
        const __m256i x = Broadcast(row + r * stride + kInputsPerGroup * g);
        if constexpr (kSigned) {
          const __m256i magnitude = _mm256_abs_epi8(x);
          tile->sum[r][0] = Instruction::Add(tile->sum[r][0], magnitude, _mm256_sign_epi8(first, x));
          tile->sum[r][1] = Instruction::Add(tile->sum[r][1], magnitude, _mm256_sign_epi8(second, x));
        } else {
          tile->sum[r][0] = Instruction::Add(tile->sum[r][0], x, first);
          tile->sum[r][1] = Instruction::Add(tile->sum[r][1], x, second);
        }
      }
    }
  }
};

}  // namespace
}  // namespace mapweld::nn
