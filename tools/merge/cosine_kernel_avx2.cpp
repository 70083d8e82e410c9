// SPDX-License-Identifier: Apache-2.0
// Exact int8 products with AVX2: both sides widened to int16, vpmaddwd and vpaddd. vpmaddubsw, with its 8-bit operands,
// saturates at 255 * 127 * 2 and needs a vpmaddwd behind it on the same ports: not faster, and not exact.
#if defined(__x86_64__)
#include <immintrin.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "tools/merge/cosine_kernel.hpp"

namespace mapweld::merge::kernels {
namespace {

constexpr int kDim = place::kDescriptorDim;
constexpr int kSteps = kDim / 4;  // of four dimensions
constexpr int kTileRows = 6;      // 6 x 8 results in 12 registers
constexpr int kTileCols = 8;      // a panel: 16 KiB, stays in the first-level cache
constexpr int kBlockRows = 96;    // 192 KiB, stays in the second-level cache
constexpr int kPanel = kTileCols * kDim;

// Eight rows of b as [step][row][4 dimensions], int16. Rows beyond the end are zero.
[[gnu::target("avx2")]] void PackPanel(const DescriptorSet& b, int begin, int end, std::int16_t* to) {
  alignas(32) static constexpr std::int8_t kNothing[kDim] = {};
  for (int half = 0; half < 2; ++half) {
    const std::int8_t* row[4];
    for (int i = 0; i < 4; ++i) {
      const int at = begin + 4 * half + i;
      row[i] = at < end ? b.row(at) : kNothing;
    }
    for (int step = 0; step < kSteps; step += 4) {
      __m128i v[4];
      for (int i = 0; i < 4; ++i) v[i] = _mm_loadu_si128(reinterpret_cast<const __m128i*>(row[i] + 4 * step));
      const __m128i low01 = _mm_unpacklo_epi32(v[0], v[1]);
      const __m128i low23 = _mm_unpacklo_epi32(v[2], v[3]);
      const __m128i high01 = _mm_unpackhi_epi32(v[0], v[1]);
      const __m128i high23 = _mm_unpackhi_epi32(v[2], v[3]);
      const __m128i four_rows[4] = {_mm_unpacklo_epi64(low01, low23), _mm_unpackhi_epi64(low01, low23),
                                    _mm_unpacklo_epi64(high01, high23), _mm_unpackhi_epi64(high01, high23)};
      for (int i = 0; i < 4; ++i) {
        auto* at = reinterpret_cast<__m256i*>(to + static_cast<std::ptrdiff_t>((step + i) * 2 + half) * 16);
        _mm256_store_si256(at, _mm256_cvtepi8_epi16(four_rows[i]));
      }
    }
  }
}

[[gnu::target("avx2")]] void WidenRow(const std::int8_t* row, std::int16_t* to) {
  for (int d = 0; d < kDim; d += 16) {
    const __m128i q = _mm_loadu_si128(reinterpret_cast<const __m128i*>(row + d));
    _mm256_store_si256(reinterpret_cast<__m256i*>(to + d), _mm256_cvtepi8_epi16(q));
  }
}

// Six rows of a (int16) times one panel. norm_a, norm_b: kTileRows and kTileCols numbers.
[[gnu::target("avx2")]] void Tile(const std::int16_t* rows, const std::int16_t* panel, const float* norm_a,
                                  const float* norm_b, std::int16_t* out, std::size_t stride) {
  __m256i sum[kTileRows][2];
#pragma GCC unroll 6
  for (auto& row : sum) row[0] = row[1] = _mm256_setzero_si256();
  for (int step = 0; step < kSteps; ++step) {
    const __m256i b0 = _mm256_load_si256(reinterpret_cast<const __m256i*>(panel + step * 32));
    const __m256i b1 = _mm256_load_si256(reinterpret_cast<const __m256i*>(panel + step * 32 + 16));
#pragma GCC unroll 6
    for (int i = 0; i < kTileRows; ++i) {
      long long four = 0;
      std::memcpy(&four, rows + i * kDim + step * 4, sizeof(four));
      const __m256i a = _mm256_set1_epi64x(four);
      sum[i][0] = _mm256_add_epi32(sum[i][0], _mm256_madd_epi16(a, b0));
      sum[i][1] = _mm256_add_epi32(sum[i][1], _mm256_madd_epi16(a, b1));
      // Row after row: GCC would first load all six, and then spill the sums.
      asm volatile("" : "+x"(sum[i][0]), "+x"(sum[i][1]));
    }
  }
  const __m256 scale_b = _mm256_loadu_ps(norm_b);
  const __m256 unit = _mm256_set1_ps(static_cast<float>(kCosineUnit));
#pragma GCC unroll 6
  for (int i = 0; i < kTileRows; ++i, out += stride) {
    // Each register holds two halves of four sums.
    const __m256i dot = _mm256_permute4x64_epi64(_mm256_hadd_epi32(sum[i][0], sum[i][1]), 0b11011000);
    const __m256 scaled = _mm256_mul_ps(_mm256_cvtepi32_ps(dot), _mm256_set1_ps(norm_a[i]));
    const __m256i rounded = _mm256_cvtps_epi32(_mm256_mul_ps(_mm256_mul_ps(scaled, scale_b), unit));
    const __m128i packed = _mm_packs_epi32(_mm256_castsi256_si128(rounded), _mm256_extracti128_si256(rounded, 1));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out), packed);
  }
}

struct alignas(32) Line {
  std::int16_t values[16];
};

}  // namespace

void CosinesAvx2(const DescriptorSet& a, KeyframeRange rows, const DescriptorSet& b, KeyframeRange cols,
                 std::int16_t* out, std::size_t stride) {
  const int panels = (cols.size() + kTileCols - 1) / kTileCols;
  static thread_local std::vector<Line> packed_b;
  static thread_local std::vector<Line> wide_a;
  packed_b.resize(static_cast<std::size_t>(panels) * kPanel / 16);
  wide_a.resize(static_cast<std::size_t>(kBlockRows) * kDim / 16);
  for (int p = 0; p < panels; ++p) {
    PackPanel(b, cols.begin + p * kTileCols, cols.end, packed_b[static_cast<std::size_t>(p) * kPanel / 16].values);
  }
  for (int block = rows.begin; block < rows.end; block += kBlockRows) {
    const int block_end = std::min(rows.end, block + kBlockRows);
    for (int i = block; i < block_end; ++i) {
      WidenRow(a.row(i), wide_a[static_cast<std::size_t>(i - block) * kDim / 16].values);
    }
    for (int p = 0; p < panels; ++p) {
      const int col = p * kTileCols;
      const int width = std::min(kTileCols, cols.size() - col);
      float norm_b[kTileCols] = {};
      std::copy_n(b.inverse_norm.data() + cols.begin + col, width, norm_b);
      for (int row = block; row < block_end; row += kTileRows) {
        const int height = std::min(kTileRows, block_end - row);
        float norm_a[kTileRows] = {};
        std::copy_n(a.inverse_norm.data() + row, height, norm_a);
        const std::int16_t* from = wide_a[static_cast<std::size_t>(row - block) * kDim / 16].values;
        const std::int16_t* panel = packed_b[static_cast<std::size_t>(p) * kPanel / 16].values;
        std::int16_t* to = out + static_cast<std::size_t>(row - rows.begin) * stride + col;
        if (height == kTileRows && width == kTileCols) {
          Tile(from, panel, norm_a, norm_b, to, stride);
          continue;
        }
        std::int16_t edge[kTileRows * kTileCols];
        Tile(from, panel, norm_a, norm_b, edge, kTileCols);
        for (int i = 0; i < height; ++i) {
          std::copy_n(edge + i * kTileCols, width, to + static_cast<std::size_t>(i) * stride);
        }
      }
    }
  }
}

}  // namespace mapweld::merge::kernels
#endif
