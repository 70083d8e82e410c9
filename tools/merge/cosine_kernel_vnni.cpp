// SPDX-License-Identifier: Apache-2.0
// Exact int8 products with AVX-512 VNNI: vpdpbusd adds four products of unsigned and signed bytes in 32 bits, without
// saturation. b is made unsigned by adding 128, and 128 times the sum of a's row is taken off again.
#if defined(__x86_64__)
#include <immintrin.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "tools/merge/cosine_kernel.hpp"

#define MAPWELD_VNNI [[gnu::target("avx512f,avx512bw,avx512vl,avx512vnni")]]

namespace mapweld::merge::kernels {
namespace {

constexpr int kDim = place::kDescriptorDim;
constexpr int kSteps = kDim / 4;  // of four dimensions
constexpr int kTileRows = 12;     // 12 x 32 results in 24 registers
constexpr int kTileCols = 32;     // two panels of 16: 32 KiB
constexpr int kBlockRows = 240;   // 240 KiB, stays in the second-level cache
constexpr int kPanel = kTileCols * kDim;
// The forms without a mask warn of an uninitialised value inside GCC 12's own header.
constexpr __mmask16 kAll = 0xFFFF;

struct alignas(64) Line {
  std::uint8_t values[64];
};

// 32 rows of b as [step][row][4 dimensions], plus 128. Rows beyond the end are zero.
void PackPanel(const DescriptorSet& b, int begin, int end, std::uint8_t* to) {
  for (int row = 0; row < kTileCols; ++row) {
    const bool inside = begin + row < end;
    for (int step = 0; step < kSteps; ++step) {
      std::uint32_t four = 0;
      if (inside) std::memcpy(&four, b.row(begin + row) + 4 * step, sizeof(four));
      four ^= 0x80808080U;
      std::memcpy(to + static_cast<std::ptrdiff_t>(step * kTileCols + row) * 4, &four, sizeof(four));
    }
  }
}

// Twelve rows of a times one pair of panels. sum_a: 128 times the sum of each row.
MAPWELD_VNNI void Tile(const std::int8_t* rows, const std::int32_t* sum_a, const std::uint8_t* panel,
                       const float* norm_a, const float* norm_b, std::int16_t* out, std::size_t stride) {
  __m512i sum[kTileRows][2];
#pragma GCC unroll 12
  for (auto& row : sum) row[0] = row[1] = _mm512_setzero_si512();
  for (int step = 0; step < kSteps; ++step) {
    const __m512i b0 = _mm512_load_si512(panel + step * 128);
    const __m512i b1 = _mm512_load_si512(panel + step * 128 + 64);
#pragma GCC unroll 12
    for (int i = 0; i < kTileRows; ++i) {
      int four = 0;
      std::memcpy(&four, rows + i * kDim + step * 4, sizeof(four));
      const __m512i a = _mm512_set1_epi32(four);
      sum[i][0] = _mm512_dpbusd_epi32(sum[i][0], b0, a);
      sum[i][1] = _mm512_dpbusd_epi32(sum[i][1], b1, a);
      asm volatile("" : "+v"(sum[i][0]), "+v"(sum[i][1]));  // row after row, as in the AVX2 kernel
    }
  }
  const __m512 unit = _mm512_set1_ps(static_cast<float>(kCosineUnit));
#pragma GCC unroll 12
  for (int i = 0; i < kTileRows; ++i, out += stride) {
#pragma GCC unroll 2
    for (int half = 0; half < 2; ++half) {
      const __m512i dot = _mm512_sub_epi32(sum[i][half], _mm512_set1_epi32(sum_a[i]));
      const __m512 scaled = _mm512_mul_ps(_mm512_maskz_cvtepi32_ps(kAll, dot), _mm512_set1_ps(norm_a[i]));
      const __m512 cosine = _mm512_mul_ps(scaled, _mm512_loadu_ps(norm_b + 16 * half));
      const __m512i rounded = _mm512_maskz_cvtps_epi32(kAll, _mm512_mul_ps(cosine, unit));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(out + 16 * half), _mm512_maskz_cvtepi32_epi16(kAll, rounded));
    }
  }
}

}  // namespace

void CosinesVnni(const DescriptorSet& a, KeyframeRange rows, const DescriptorSet& b, KeyframeRange cols,
                 std::int16_t* out, std::size_t stride) {
  const int panels = (cols.size() + kTileCols - 1) / kTileCols;
  static thread_local std::vector<Line> packed_b;
  packed_b.resize(static_cast<std::size_t>(panels) * kPanel / 64);
  for (int p = 0; p < panels; ++p) {
    PackPanel(b, cols.begin + p * kTileCols, cols.end, packed_b[static_cast<std::size_t>(p) * kPanel / 64].values);
  }
  std::vector<std::int32_t> sum_a(static_cast<std::size_t>(rows.size() + kTileRows), 0);
  for (int i = rows.begin; i < rows.end; ++i) {
    std::int32_t sum = 0;
    for (int d = 0; d < kDim; ++d) sum += a.row(i)[d];
    sum_a[static_cast<std::size_t>(i - rows.begin)] = 128 * sum;
  }
  for (int block = rows.begin; block < rows.end; block += kBlockRows) {
    const int block_end = std::min(rows.end, block + kBlockRows);
    for (int p = 0; p < panels; ++p) {
      const int col = p * kTileCols;
      const int width = std::min(kTileCols, cols.size() - col);
      float norm_b[kTileCols] = {};
      std::copy_n(b.inverse_norm.data() + cols.begin + col, width, norm_b);
      for (int row = block; row < block_end; row += kTileRows) {
        const int height = std::min(kTileRows, block_end - row);
        float norm_a[kTileRows] = {};
        std::copy_n(a.inverse_norm.data() + row, height, norm_a);
        const std::int32_t* sums = sum_a.data() + (row - rows.begin);
        const std::uint8_t* panel = packed_b[static_cast<std::size_t>(p) * kPanel / 64].values;
        std::int16_t* to = out + static_cast<std::size_t>(row - rows.begin) * stride + col;
        if (height == kTileRows && width == kTileCols) {
          Tile(a.row(row), sums, panel, norm_a, norm_b, to, stride);
          continue;
        }
        std::int16_t edge[kTileRows * kTileCols];
        std::int8_t padded[kTileRows * kDim] = {};
        std::copy_n(a.row(row), height * kDim, padded);
        Tile(padded, sums, panel, norm_a, norm_b, edge, kTileCols);
        for (int i = 0; i < height; ++i) {
          std::copy_n(edge + i * kTileCols, width, to + static_cast<std::size_t>(i) * stride);
        }
      }
    }
  }
}

}  // namespace mapweld::merge::kernels
#endif
