// SPDX-License-Identifier: Apache-2.0
#include "core/nn/avx2.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

namespace mapweld::nn {

// Sixteen channels of four rows at a time; other sizes take the plain way. (Needs no more than SSE2.)
void PackRowsAvx2(const std::int8_t* rows, std::size_t count, std::size_t channels, std::int8_t* out) {
  if (count != kPackedRows || channels % 16 != 0) return PackRowsPortable(rows, count, channels, out);
  const auto load = [](const std::int8_t* from) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from)); };
  const auto store = [](std::int8_t* to, __m128i v) { _mm_storeu_si128(reinterpret_cast<__m128i*>(to), v); };
  constexpr std::size_t kGroupBytes = kOutputsPerBlock * kInputsPerGroup;
  constexpr std::size_t kBlockBytes = kPackedRows * kOutputsPerBlock;
  for (std::size_t m = 0; m < kPackedRows; m += 4) {
    const std::int8_t* row = rows + m * channels;
    std::int8_t* group = out + m / kInputsPerGroup * kGroupBytes;
    for (std::size_t c = 0; c < channels; c += 16, row += 16, group += 2 * kBlockBytes) {
      const __m128i r0 = load(row), r1 = load(row + channels);
      const __m128i r2 = load(row + 2 * channels), r3 = load(row + 3 * channels);
      const __m128i lo01 = _mm_unpacklo_epi8(r0, r1), hi01 = _mm_unpackhi_epi8(r0, r1);
      const __m128i lo23 = _mm_unpacklo_epi8(r2, r3), hi23 = _mm_unpackhi_epi8(r2, r3);
      store(group, _mm_unpacklo_epi16(lo01, lo23));
      store(group + 16, _mm_unpackhi_epi16(lo01, lo23));
      store(group + kBlockBytes, _mm_unpacklo_epi16(hi01, hi23));
      store(group + kBlockBytes + 16, _mm_unpackhi_epi16(hi01, hi23));
    }
  }
}

}  // namespace mapweld::nn
#endif
