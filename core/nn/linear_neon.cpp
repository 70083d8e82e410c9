// SPDX-License-Identifier: Apache-2.0
#include "core/nn/neon.hpp"

#if defined(__aarch64__)
#include "core/nn/linear_tiles_neon.hpp"

namespace mapweld::nn {
namespace {

MAPWELD_TILE_INLINE int8x8_t FourTwice(const std::int8_t* from) {
  std::int32_t four = 0;
  __builtin_memcpy(&four, from, 4);
  return vreinterpret_s8_s32(vdup_n_s32(four));
}

// Per row and two outputs: the products of two groups in eight 16-bit sums of two (2 * 127 * 127 < 2^15), added in
// pairs to four 32-bit sums, of which two belong to each output.
struct NeonDot {
  template <std::size_t R>
  MAPWELD_TILE_INLINE static void Add(Tile<R>* tile, const std::int8_t* w, const std::int8_t* row, std::size_t stride,
                                      std::size_t groups) {
    int32x4_t sum[R][4];
    for (std::size_t r = 0; r < R; ++r) {
      for (std::size_t q = 0; q < 4; ++q) sum[r][q] = vdupq_n_s32(0);
    }
    std::size_t g = 0;
    for (; g + 2 <= groups; g += 2, w += 2 * kGroupBytes) {
      for (std::size_t r = 0; r < R; ++r) {
        const std::int8_t* at = row + r * stride + kInputsPerGroup * g;
        const int8x8_t x0 = FourTwice(at), x1 = FourTwice(at + kInputsPerGroup);
        for (std::size_t q = 0; q < 4; ++q) {
          const int16x8_t products = vmull_s8(x0, vld1_s8(w + 8 * q));
          sum[r][q] = vpadalq_s16(sum[r][q], vmlal_s8(products, x1, vld1_s8(w + kGroupBytes + 8 * q)));
        }
      }
    }
    for (; g < groups; ++g, w += kGroupBytes) {
      for (std::size_t r = 0; r < R; ++r) {
        const int8x8_t x = FourTwice(row + r * stride + kInputsPerGroup * g);
        for (std::size_t q = 0; q < 4; ++q) sum[r][q] = vpadalq_s16(sum[r][q], vmull_s8(x, vld1_s8(w + 8 * q)));
      }
    }
    for (std::size_t r = 0; r < R; ++r) {
      tile->sum[r][0] = vaddq_s32(tile->sum[r][0], vpaddq_s32(sum[r][0], sum[r][1]));
      tile->sum[r][1] = vaddq_s32(tile->sum[r][1], vpaddq_s32(sum[r][2], sum[r][3]));
    }
  }
};

}  // namespace

void LinearNeon(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int8_t* out) {
  Walk<NeonDot>(layer, rows, count, StoreBytes(layer, out));
}
void LinearSumsNeon(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int32_t* out) {
  Walk<NeonDot>(layer, rows, count, StoreSums(layer, out));
}

}  // namespace mapweld::nn
#endif
