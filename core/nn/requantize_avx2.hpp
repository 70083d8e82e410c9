// SPDX-License-Identifier: Apache-2.0
// ScaleSum() and Requantize() of linear.hpp for eight outputs at a time.
#pragma once

#include <immintrin.h>

#include <cstdint>

#define MAPWELD_AVX2_INLINE __attribute__((target("avx2"), always_inline)) inline

namespace mapweld::nn::avx2 {

// AVX2 shifts 64-bit lanes to the right as unsigned numbers only. So 2^62 is added before the shift, which makes every
// product positive, and 2^(62 - shift) taken away after it.
struct Requantizer {
  __m256i multiplier_even, multiplier_odd;
  __m256i round_even, round_odd;
  __m256i shift_even, shift_odd;
  __m256i offset;
};

MAPWELD_AVX2_INLINE Requantizer MakeRequantizer(const std::int32_t* multipliers, const std::int32_t* shifts) {
  const __m256i multiplier = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(multipliers));
  const __m256i shift = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(shifts));
  const __m256i even = _mm256_and_si256(shift, _mm256_set1_epi64x(0xFFFFFFFF));
  const __m256i odd = _mm256_srli_epi64(shift, 32);
  const __m256i one = _mm256_set1_epi64x(1);
  const __m256i positive = _mm256_set1_epi64x(std::int64_t{1} << 62);
  Requantizer r;
  r.multiplier_even = multiplier;
  r.multiplier_odd = _mm256_srli_epi64(multiplier, 32);
  r.round_even = _mm256_add_epi64(positive, _mm256_sllv_epi64(one, _mm256_sub_epi64(even, one)));
  r.round_odd = _mm256_add_epi64(positive, _mm256_sllv_epi64(one, _mm256_sub_epi64(odd, one)));
  r.shift_even = even;
  r.shift_odd = _mm256_sub_epi64(odd, _mm256_set1_epi64x(32));  // the result stays in the upper half
  r.offset = _mm256_sllv_epi32(_mm256_set1_epi32(1), _mm256_sub_epi32(_mm256_set1_epi32(62), shift));
  return r;
}

// Eight sums to eight 32-bit results, not clamped.
MAPWELD_AVX2_INLINE __m256i Scale(const Requantizer& r, __m256i sums) {
  __m256i even = _mm256_mul_epi32(sums, r.multiplier_even);
  __m256i odd = _mm256_mul_epi32(_mm256_srli_epi64(sums, 32), r.multiplier_odd);
  even = _mm256_srlv_epi64(_mm256_add_epi64(even, r.round_even), r.shift_even);
  odd = _mm256_srlv_epi64(_mm256_add_epi64(odd, r.round_odd), r.shift_odd);
  return _mm256_sub_epi32(_mm256_blend_epi32(even, odd, 0xAA), r.offset);
}

// Two rows of two blocks to 16 bytes of the first row and 16 of the second.
MAPWELD_AVX2_INLINE __m256i Pack(__m256i first_a, __m256i first_b, __m256i second_a, __m256i second_b, __m256i lowest) {
  const __m256i first = _mm256_packs_epi32(first_a, first_b);
  const __m256i second = _mm256_packs_epi32(second_a, second_b);
  const __m256i bytes = _mm256_max_epi8(_mm256_packs_epi16(first, second), lowest);
  return _mm256_permutevar8x32_epi32(bytes, _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7));
}

}  // namespace mapweld::nn::avx2
