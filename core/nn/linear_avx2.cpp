// SPDX-License-Identifier: Apache-2.0
#include "core/nn/avx2.hpp"

#if defined(__x86_64__)
#define MAPWELD_TILE_TARGET "avx2"
#include "core/nn/linear_tiles_x86.hpp"

namespace mapweld::nn {
namespace {

// Four products in four 16-bit sums of two. maddubs wants one operand without sign: the activations as they are when
// none of them is negative (after a ReLU), else their magnitudes, with their signs moved to the weights.
template <bool kSigned>
MAPWELD_TILE_INLINE __m256i PairSums(__m256i x, __m256i w) {
  if constexpr (kSigned) return _mm256_maddubs_epi16(_mm256_abs_epi8(x), _mm256_sign_epi8(w, x));
  return _mm256_maddubs_epi16(x, w);
}

MAPWELD_TILE_INLINE void AddPairSums(__m256i* sum, __m256i pairs) {
  *sum = _mm256_add_epi32(*sum, _mm256_madd_epi16(pairs, _mm256_set1_epi16(1)));
}

// A pair sums up to 2 * 127 * 127 < 2^15 at most; of a narrow layer two pairs do, which saves every second madd.
struct Dot {
  static constexpr bool kUsesNarrow = true;
  template <std::size_t R, bool kNarrow, bool kSigned>
  MAPWELD_TILE_INLINE static void Add(Tile<R>* tile, const std::int8_t* w0, const std::int8_t* w1,
                                      const std::int8_t* row, std::size_t stride, std::size_t groups) {
    std::size_t g = 0;
    if constexpr (kNarrow) {
      for (; g + 2 <= groups; g += 2) {
        const __m256i w00 = Load(w0 + kGroupBytes * g), w01 = Load(w0 + kGroupBytes * (g + 1));
        const __m256i w10 = Load(w1 + kGroupBytes * g), w11 = Load(w1 + kGroupBytes * (g + 1));
        for (std::size_t r = 0; r < R; ++r) {
          const std::int8_t* at = row + r * stride + kInputsPerGroup * g;
          const __m256i x0 = Broadcast(at), x1 = Broadcast(at + kInputsPerGroup);
          AddPairSums(&tile->sum[r][0], _mm256_add_epi16(PairSums<kSigned>(x0, w00), PairSums<kSigned>(x1, w01)));
          AddPairSums(&tile->sum[r][1], _mm256_add_epi16(PairSums<kSigned>(x0, w10), PairSums<kSigned>(x1, w11)));
        }
      }
    }
    for (; g < groups; ++g) {
      const __m256i w00 = Load(w0 + kGroupBytes * g), w10 = Load(w1 + kGroupBytes * g);
      for (std::size_t r = 0; r < R; ++r) {
        const __m256i x = Broadcast(row + r * stride + kInputsPerGroup * g);
        AddPairSums(&tile->sum[r][0], PairSums<kSigned>(x, w00));
        AddPairSums(&tile->sum[r][1], PairSums<kSigned>(x, w10));
      }
    }
  }
};

}  // namespace

MAPWELD_TILE void LinearAvx2(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int8_t* out) {
  Walk<Dot>(layer, rows, count, StoreBytes(layer, out));
}
MAPWELD_TILE void LinearSumsAvx2(const LinearLayer& layer, const std::int8_t* rows, std::size_t count,
                                 std::int32_t* out) {
  Walk<Dot>(layer, rows, count, StoreSums(layer, out));
}

}  // namespace mapweld::nn
#endif
