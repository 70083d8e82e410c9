// SPDX-License-Identifier: Apache-2.0
#include "core/nn/neon.hpp"

#if defined(__aarch64__)
#define MAPWELD_TILE __attribute__((target("arch=armv8.2-a+dotprod")))
#include "core/nn/linear_tiles_neon.hpp"

namespace mapweld::nn {
namespace {

// sdot: four products added to each of four 32-bit sums, the activations picked out of a register of four groups.
struct ProductDot {
  template <std::size_t R>
  MAPWELD_TILE_INLINE static void Add(Tile<R>* tile, const std::int8_t* w, const std::int8_t* row, std::size_t stride,
                                      std::size_t groups) {
    std::size_t g = 0;
    for (; g + 4 <= groups; g += 4, w += 4 * kGroupBytes) {
      for (std::size_t r = 0; r < R; ++r) {
        const int8x16_t x = vld1q_s8(row + r * stride + kInputsPerGroup * g);
        int32x4_t low = tile->sum[r][0], high = tile->sum[r][1];
        low = vdotq_laneq_s32(low, vld1q_s8(w), x, 0);
        high = vdotq_laneq_s32(high, vld1q_s8(w + 16), x, 0);
        low = vdotq_laneq_s32(low, vld1q_s8(w + 32), x, 1);
        high = vdotq_laneq_s32(high, vld1q_s8(w + 48), x, 1);
        low = vdotq_laneq_s32(low, vld1q_s8(w + 64), x, 2);
        high = vdotq_laneq_s32(high, vld1q_s8(w + 80), x, 2);
        low = vdotq_laneq_s32(low, vld1q_s8(w + 96), x, 3);
        high = vdotq_laneq_s32(high, vld1q_s8(w + 112), x, 3);
        tile->sum[r][0] = low;
        tile->sum[r][1] = high;
      }
    }
    for (; g < groups; ++g, w += kGroupBytes) {
      for (std::size_t r = 0; r < R; ++r) {
        std::int32_t four = 0;
        __builtin_memcpy(&four, row + r * stride + kInputsPerGroup * g, 4);
        const int8x16_t x = vreinterpretq_s8_s32(vdupq_n_s32(four));
        tile->sum[r][0] = vdotq_s32(tile->sum[r][0], vld1q_s8(w), x);
        tile->sum[r][1] = vdotq_s32(tile->sum[r][1], vld1q_s8(w + 16), x);
      }
    }
  }
};

}  // namespace

MAPWELD_TILE void LinearDotProduct(const LinearLayer& layer, const std::int8_t* rows, std::size_t count,
                                   std::int8_t* out) {
  Walk<ProductDot>(layer, rows, count, StoreBytes(layer, out));
}
MAPWELD_TILE void LinearSumsDotProduct(const LinearLayer& layer, const std::int8_t* rows, std::size_t count,
                                       std::int32_t* out) {
  Walk<ProductDot>(layer, rows, count, StoreSums(layer, out));
}

}  // namespace mapweld::nn
#endif
