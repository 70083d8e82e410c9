// SPDX-License-Identifier: Apache-2.0
// The walk over rows and outputs that the x86-64 kernels share: tiles of 4 rows x 16 outputs, whose sums stay in
// registers. A kernel's source defines MAPWELD_TILE_TARGET (what its processor must have) before it includes this,
// once, and gives
//   struct Dot {
//     static constexpr bool kUsesNarrow;  // whether it does better on a narrow layer
//     template <std::size_t R, bool kNarrow, bool kSigned> static void Add(tile, w0, w1, row, stride, groups);
//   };
// Everything here is private to that source: the same code compiled for another target must not be merged with it.
#pragma once

#include "core/nn/linear.hpp"
#include "core/nn/requantize_avx2.hpp"

#define MAPWELD_TILE __attribute__((target(MAPWELD_TILE_TARGET)))
#define MAPWELD_TILE_INLINE __attribute__((target(MAPWELD_TILE_TARGET), always_inline)) inline

namespace mapweld::nn {
namespace {

constexpr std::size_t kTileRows = 4;
constexpr std::size_t kStripRows = 64;  // whose activations stay in the first-level cache while all outputs pass
constexpr std::size_t kPairOutputs = 2 * kOutputsPerBlock;
constexpr std::size_t kGroupBytes = kOutputsPerBlock * kInputsPerGroup;

// Sums of R rows for the eight outputs of two blocks.
template <std::size_t R>
struct Tile {
  __m256i sum[R][2];
};

// Compilers that tune for old processors split the ordinary unaligned load into two halves; this one stays whole.
MAPWELD_TILE_INLINE __m256i Load(const void* from) {
  return _mm256_lddqu_si256(static_cast<const __m256i*>(from));
}
MAPWELD_TILE_INLINE __m256i Broadcast(const std::int8_t* from) {
  std::int32_t four = 0;
  __builtin_memcpy(&four, from, 4);
  return _mm256_set1_epi32(four);
}

MAPWELD_TILE_INLINE bool AnyNegative(const std::int8_t* bytes, std::size_t count) {
  std::uint32_t any = 0;
  for (std::size_t i = 0; i < count; i += 4) {
    std::uint32_t four = 0;
    __builtin_memcpy(&four, bytes + i, 4);
    any |= four;
  }
  return (any & 0x80808080U) != 0;
}

// Requantised bytes.
class StoreBytes {
 public:
  MAPWELD_TILE_INLINE StoreBytes(const LinearLayer& layer, std::int8_t* out)
      : layer_(layer), out_(out), stride_(RowStride(layer.p.outputs)) {}
  MAPWELD_TILE_INLINE void Begin(std::size_t block0, std::size_t block1) {
    first_ = RequantizerOf(block0);
    second_ = RequantizerOf(block1);
    lowest_ = _mm256_set1_epi8(static_cast<char>(layer_.p.lowest));
    at_ = block0 * kOutputsPerBlock;
    width_ = stride_ - at_ < kPairOutputs ? stride_ - at_ : kPairOutputs;
  }
  template <std::size_t R>
  MAPWELD_TILE_INLINE void Put(std::size_t row, const Tile<R>& tile) const {
    for (std::size_t r = 0; r < R; r += 2) {
      constexpr std::size_t kNext = R > 1 ? 1 : 0;
      const __m256i bytes = avx2::Pack(avx2::Scale(first_, tile.sum[r][0]), avx2::Scale(second_, tile.sum[r][1]),
                                       avx2::Scale(first_, tile.sum[r + kNext][0]),
                                       avx2::Scale(second_, tile.sum[r + kNext][1]), lowest_);
      PutRow(row + r, _mm256_castsi256_si128(bytes));
      if constexpr (R > 1) PutRow(row + r + 1, _mm256_extracti128_si256(bytes, 1));
    }
  }

 private:
  MAPWELD_TILE_INLINE avx2::Requantizer RequantizerOf(std::size_t block) const {
    return avx2::MakeRequantizer(layer_.p.multiplier.data() + block * kOutputsPerBlock,
                                 layer_.p.shift.data() + block * kOutputsPerBlock);
  }
  MAPWELD_TILE_INLINE void PutRow(std::size_t row, __m128i bytes) const {
    std::int8_t* to = out_ + row * stride_ + at_;
    if (width_ == kPairOutputs) {
      _mm_storeu_si128(reinterpret_cast<__m128i*>(to), bytes);
    } else {
      alignas(16) std::int8_t all[kPairOutputs];
      _mm_store_si128(reinterpret_cast<__m128i*>(all), bytes);
      for (std::size_t i = 0; i < width_; ++i) to[i] = all[i];
    }
  }
  const LinearLayer& layer_;
  std::int8_t* out_;
  std::size_t stride_;
  std::size_t at_ = 0;
  std::size_t width_ = 0;
  avx2::Requantizer first_, second_;
  __m256i lowest_;
};

// The sums as they are.
class StoreSums {
 public:
  MAPWELD_TILE_INLINE StoreSums(const LinearLayer& layer, std::int32_t* out)
      : out_(out), stride_(SumStride(layer.p.outputs)) {}
  MAPWELD_TILE_INLINE void Begin(std::size_t block0, std::size_t block1) {
    at0_ = block0 * kOutputsPerBlock;
    at1_ = block1 * kOutputsPerBlock;
  }
  template <std::size_t R>
  MAPWELD_TILE_INLINE void Put(std::size_t row, const Tile<R>& tile) const {
    for (std::size_t r = 0; r < R; ++r) {
      std::int32_t* to = out_ + (row + r) * stride_;
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + at0_), tile.sum[r][0]);
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + at1_), tile.sum[r][1]);
    }
  }

 private:
  std::int32_t* out_;
  std::size_t stride_;
  std::size_t at0_ = 0;
  std::size_t at1_ = 0;
};

template <class Dot, std::size_t R, bool kNarrow, bool kSigned, class Store>
MAPWELD_TILE_INLINE void OneTile(const LinearLayer& layer, std::size_t block0, std::size_t block1,
                                 const std::int8_t* rows, std::size_t row, const Store& store) {
  const std::size_t groups = layer.groups();
  const std::size_t stride = RowStride(layer.p.inputs);
  const __m256i bias0 = Load(layer.p.bias.data() + block0 * kOutputsPerBlock);
  const __m256i bias1 = Load(layer.p.bias.data() + block1 * kOutputsPerBlock);
  Tile<R> tile;
  for (std::size_t r = 0; r < R; ++r) {
    tile.sum[r][0] = bias0;
    tile.sum[r][1] = bias1;
  }
  const std::int8_t* w = layer.p.weights.data();
  Dot::template Add<R, kNarrow, kSigned>(&tile, w + block0 * groups * kGroupBytes, w + block1 * groups * kGroupBytes,
                                         rows + row * stride, stride, groups);
  store.template Put<R>(row, tile);
}

// A tile from end to end for each kind, so that the sums need not leave their registers between.
template <class Dot, std::size_t R, class Store>
MAPWELD_TILE_INLINE void AnyTile(const LinearLayer& layer, std::size_t block0, std::size_t block1, bool negative,
                                 const std::int8_t* rows, std::size_t row, const Store& store) {
  if (Dot::kUsesNarrow && layer.narrow) {
    if (negative) return OneTile<Dot, R, true, true>(layer, block0, block1, rows, row, store);
    return OneTile<Dot, R, true, false>(layer, block0, block1, rows, row, store);
  }
  if (negative) return OneTile<Dot, R, false, true>(layer, block0, block1, rows, row, store);
  OneTile<Dot, R, false, false>(layer, block0, block1, rows, row, store);
}

// An odd last block is computed twice, beside itself.
template <class Dot, class Store>
MAPWELD_TILE_INLINE void Walk(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, Store store) {
  const std::size_t stride = RowStride(layer.p.inputs);
  const std::size_t blocks = layer.blocks();
  for (std::size_t strip = 0; strip < count; strip += kStripRows) {
    const std::size_t end = strip + kStripRows < count ? strip + kStripRows : count;
    std::uint32_t negative = 0;  // a bit per tile, the last for all rows that do not fill one
    for (std::size_t row = strip, bit = 0; row < end; row += kTileRows, ++bit) {
      const std::size_t n = row + kTileRows < end ? kTileRows : end - row;
      negative |= static_cast<std::uint32_t>(AnyNegative(rows + row * stride, n * stride)) << bit;
    }
    for (std::size_t block0 = 0; block0 < blocks; block0 += 2) {
      const std::size_t block1 = block0 + 1 < blocks ? block0 + 1 : block0;
      store.Begin(block0, block1);
      std::size_t row = strip;
      std::uint32_t signs = negative;
      for (; row + kTileRows <= end; row += kTileRows, signs >>= 1U) {
        AnyTile<Dot, kTileRows>(layer, block0, block1, (signs & 1U) != 0, rows, row, store);
      }
      for (; row < end; ++row) AnyTile<Dot, 1>(layer, block0, block1, (signs & 1U) != 0, rows, row, store);
    }
  }
}

}  // namespace
}  // namespace mapweld::nn
