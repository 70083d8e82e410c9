// SPDX-License-Identifier: Apache-2.0
#include "core/nn/avx2.hpp"

#if defined(__x86_64__)
#include "core/nn/exponential.hpp"
#include "core/nn/requantize_avx2.hpp"

#define MAPWELD_AVX2 __attribute__((target("avx2")))

namespace mapweld::nn {
namespace {

constexpr std::size_t kLanes = 8;
constexpr std::size_t kVectors = kMaxClusters / kLanes;

// Exp2Down() of eight.
MAPWELD_AVX2_INLINE __m256i Exp2DownEight(__m256i d) {
  const __m256i capped = _mm256_min_epi32(d, _mm256_set1_epi32(4096));
  const __m256i f = _mm256_and_si256(capped, _mm256_set1_epi32(255));
  __m256i p =
      _mm256_sub_epi32(_mm256_set1_epi32(7520), _mm256_srai_epi32(_mm256_mullo_epi32(f, _mm256_set1_epi32(1262)), 8));
  p = _mm256_sub_epi32(_mm256_set1_epi32(22642), _mm256_srai_epi32(_mm256_mullo_epi32(f, p), 8));
  p = _mm256_sub_epi32(_mm256_set1_epi32(32768), _mm256_srai_epi32(_mm256_mullo_epi32(f, p), 8));
  return _mm256_srav_epi32(p, _mm256_srai_epi32(capped, 8));
}

MAPWELD_AVX2_INLINE __m256i LargestInAllLanes(__m256i v) {
  v = _mm256_max_epi32(v, _mm256_permute2x128_si256(v, v, 1));
  v = _mm256_max_epi32(v, _mm256_shuffle_epi32(v, 0x4E));
  return _mm256_max_epi32(v, _mm256_shuffle_epi32(v, 0xB1));
}

MAPWELD_AVX2_INLINE std::uint32_t Total(__m256i v) {
  __m128i half = _mm_add_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
  half = _mm_add_epi32(half, _mm_shuffle_epi32(half, 0x4E));
  half = _mm_add_epi32(half, _mm_shuffle_epi32(half, 0xB1));
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(half));
}

struct Scales {
  avx2::Requantizer vector[kVectors];
  __m256i nobody;  // of the last vector: lanes behind the last cluster
  std::size_t vectors;
};

// The shares of one row, a byte per cluster.
MAPWELD_AVX2_INLINE void OneRow(const Scales& scales, const std::int32_t* sums, std::uint8_t* shares) {
  // No logit is as small, and its distance to the largest does not overflow either.
  const __m256i none = _mm256_set1_epi32(-(1 << 30));
  __m256i e[kVectors];
  __m256i largest = none;
  for (std::size_t i = 0; i < scales.vectors; ++i) {
    e[i] = avx2::Scale(scales.vector[i], _mm256_loadu_si256(reinterpret_cast<const __m256i*>(sums + kLanes * i)));
    if (i + 1 == scales.vectors) e[i] = _mm256_blendv_epi8(e[i], none, scales.nobody);
    largest = _mm256_max_epi32(largest, e[i]);
  }
  largest = LargestInAllLanes(largest);
  __m256i total = _mm256_setzero_si256();
  for (std::size_t i = 0; i < scales.vectors; ++i) {
    e[i] = Exp2DownEight(_mm256_sub_epi32(largest, e[i]));
    total = _mm256_add_epi32(total, e[i]);
  }
  const std::uint32_t factor = (std::uint32_t{kWholeShare} << 24U) / Total(total);
  const __m256i factors = _mm256_set1_epi32(static_cast<std::int32_t>(factor));
  const __m256i low_bytes = _mm256_setr_epi8(0, 4, 8, 12, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1,  //
                                             0, 4, 8, 12, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1);
  for (std::size_t i = 0; i < scales.vectors; ++i) {
    __m256i share = _mm256_add_epi32(_mm256_mullo_epi32(e[i], factors), _mm256_set1_epi32(1 << 23));
    share = _mm256_shuffle_epi8(_mm256_srli_epi32(share, 24), low_bytes);
    _mm_storel_epi64(reinterpret_cast<__m128i*>(shares + kLanes * i),
                     _mm_unpacklo_epi32(_mm256_castsi256_si128(share), _mm256_extracti128_si256(share, 1)));
  }
}

MAPWELD_AVX2_INLINE __m128i LoadEight(const std::uint8_t* from) {
  return _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from));
}

// Rows `stride` apart, two after each other, byte by byte.
MAPWELD_AVX2_INLINE __m128i Interleave(const std::uint8_t* from, std::size_t stride) {
  return _mm_unpacklo_epi8(LoadEight(from), LoadEight(from + stride));
}

// Eight rows of eight bytes, each row `stride` apart, to eight columns.
MAPWELD_AVX2_INLINE void Transpose8x8(const std::uint8_t* from, std::size_t stride, std::uint8_t (*to)[8]) {
  const __m128i r01 = Interleave(from, stride), r23 = Interleave(from + 2 * stride, stride);
  const __m128i r45 = Interleave(from + 4 * stride, stride), r67 = Interleave(from + 6 * stride, stride);
  const __m128i a = _mm_unpacklo_epi16(r01, r23), b = _mm_unpackhi_epi16(r01, r23);
  const __m128i c = _mm_unpacklo_epi16(r45, r67), d = _mm_unpackhi_epi16(r45, r67);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to[0]), _mm_unpacklo_epi32(a, c));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to[2]), _mm_unpackhi_epi32(a, c));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to[4]), _mm_unpacklo_epi32(b, d));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to[6]), _mm_unpackhi_epi32(b, d));
}

}  // namespace

MAPWELD_AVX2 void SoftAssignAvx2(const LogitScale& scale, std::size_t clusters, const std::int32_t* sums,
                                 std::size_t count, std::int8_t* shares, std::size_t share_stride) {
  Scales scales;
  scales.vectors = SumStride(clusters) / kLanes;
  for (std::size_t i = 0; i < scales.vectors; ++i) {
    scales.vector[i] = avx2::MakeRequantizer(scale.multiplier.data() + kLanes * i, scale.shift.data() + kLanes * i);
  }
  const auto in_last = static_cast<std::int32_t>(clusters - kLanes * (scales.vectors - 1));
  scales.nobody = _mm256_cmpgt_epi32(_mm256_setr_epi32(1, 2, 3, 4, 5, 6, 7, 8), _mm256_set1_epi32(in_last));
  alignas(32) std::uint8_t by_row[kLanes][kMaxClusters] = {};
  alignas(16) std::uint8_t by_cluster[8][8];
  for (std::size_t first = 0; first < count; first += kLanes) {
    const std::size_t rows = count - first < kLanes ? count - first : kLanes;
    for (std::size_t r = 0; r < rows; ++r) OneRow(scales, sums + (first + r) * SumStride(clusters), by_row[r]);
    for (std::size_t k = 0; k < clusters; k += 8) {
      Transpose8x8(&by_row[0][k], kMaxClusters, by_cluster);
      for (std::size_t i = 0; i < 8 && k + i < clusters; ++i) {
        __builtin_memcpy(shares + (k + i) * share_stride + first, by_cluster[i], rows);
      }
    }
  }
}

}  // namespace mapweld::nn
#endif
