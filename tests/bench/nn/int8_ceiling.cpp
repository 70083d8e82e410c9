// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/nn/nn_bench.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

namespace mapweld::bench {

// The three instructions that AVX2 needs: byte products in pairs, pairs of those, sum. Eight chains keep the units
// busy.
__attribute__((target("avx2"))) double RunInt8Ceiling() {
  constexpr int kSteps = 100000, kChains = 8;
  const __m256i ones = _mm256_set1_epi16(1);
  __m256i sum[kChains], w[4];
  for (__m256i& s : sum) s = _mm256_setzero_si256();
  for (int i = 0; i < 4; ++i) w[i] = _mm256_set1_epi8(static_cast<char>(i + 3));
  __m256i x = _mm256_set1_epi8(5);
  for (int step = 0; step < kSteps; ++step) {
#pragma GCC unroll 8
    for (int i = 0; i < kChains; ++i) {
      __asm__ volatile("" : "+x"(x));  // a new x every time, as far as the compiler knows
      sum[i] = _mm256_add_epi32(sum[i], _mm256_madd_epi16(_mm256_maddubs_epi16(x, w[i % 4]), ones));
      __asm__ volatile("" : "+x"(sum[i]));
    }
  }
  return 2.0 * 32 * kSteps * kChains;
}

}  // namespace mapweld::bench
#else
namespace mapweld::bench {
double RunInt8Ceiling() {
  return 0;
}
}  // namespace mapweld::bench
#endif
