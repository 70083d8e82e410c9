// SPDX-License-Identifier: Apache-2.0
// The walk over rows and outputs that both 64-bit ARM kernels share: tiles of 4 rows x 8 outputs, whose sums stay in
// registers. A kernel gives   struct Dot { template <std::size_t R> static void Add(tile, w, row, stride, groups); };
// which adds to tile->sum[r][0] (outputs 0-3) and tile->sum[r][1] (outputs 4-7).
#pragma once

#include <arm_neon.h>

#include "core/nn/linear.hpp"

#ifndef MAPWELD_TILE
#define MAPWELD_TILE
#endif
#define MAPWELD_TILE_INLINE MAPWELD_TILE __attribute__((always_inline)) inline

namespace mapweld::nn {
namespace {

constexpr std::size_t kTileRows = 4;
constexpr std::size_t kStripRows = 64;  // whose activations stay in the first-level cache while all outputs pass
constexpr std::size_t kGroupBytes = kOutputsPerBlock * kInputsPerGroup;

template <std::size_t R>
struct Tile {
  int32x4_t sum[R][2];
};

// ScaleSum() of four: a rounding shift to the right is what it is.
MAPWELD_TILE_INLINE int32x4_t Scale(int32x4_t sums, int32x4_t multiplier, int32x4_t shift) {
  const int64x2_t low = vmull_s32(vget_low_s32(sums), vget_low_s32(multiplier));
  const int64x2_t high = vmull_high_s32(sums, multiplier);
  const int32x4_t left = vnegq_s32(shift);
  return vcombine_s32(vmovn_s64(vrshlq_s64(low, vmovl_s32(vget_low_s32(left)))),
                      vmovn_s64(vrshlq_s64(high, vmovl_high_s32(left))));
}

class StoreBytes {
 public:
  StoreBytes(const LinearLayer& layer, std::int8_t* out)
      : layer_(layer), out_(out), stride_(RowStride(layer.p.outputs)) {}
  template <std::size_t R>
  MAPWELD_TILE_INLINE void Put(std::size_t row, std::size_t block, const Tile<R>& tile) const {
    const std::size_t at = block * kOutputsPerBlock;
    const std::int32_t* multiplier = layer_.p.multiplier.data() + at;
    const std::int32_t* shift = layer_.p.shift.data() + at;
    for (std::size_t r = 0; r < R; ++r) {
      const int32x4_t low = Scale(tile.sum[r][0], vld1q_s32(multiplier), vld1q_s32(shift));
      const int32x4_t high = Scale(tile.sum[r][1], vld1q_s32(multiplier + 4), vld1q_s32(shift + 4));
      const int8x8_t bytes = vmax_s8(vqmovn_s16(vcombine_s16(vqmovn_s32(low), vqmovn_s32(high))),
                                     vdup_n_s8(static_cast<std::int8_t>(layer_.p.lowest)));
      std::int8_t* to = out_ + (row + r) * stride_ + at;
      if (stride_ - at >= kOutputsPerBlock) {
        vst1_s8(to, bytes);
      } else {
        std::int8_t all[kOutputsPerBlock];
        vst1_s8(all, bytes);
        __builtin_memcpy(to, all, stride_ - at);
      }
    }
  }

 private:
  const LinearLayer& layer_;
  std::int8_t* out_;
  std::size_t stride_;
};

class StoreSums {
 public:
  StoreSums(const LinearLayer& layer, std::int32_t* out) : out_(out), stride_(SumStride(layer.p.outputs)) {}
  template <std::size_t R>
  MAPWELD_TILE_INLINE void Put(std::size_t row, std::size_t block, const Tile<R>& tile) const {
    for (std::size_t r = 0; r < R; ++r) {
      std::int32_t* to = out_ + (row + r) * stride_ + block * kOutputsPerBlock;
      vst1q_s32(to, tile.sum[r][0]);
      vst1q_s32(to + 4, tile.sum[r][1]);
    }
  }

 private:
  std::int32_t* out_;
  std::size_t stride_;
};

template <class Dot, std::size_t R, class Store>
MAPWELD_TILE_INLINE void OneTile(const LinearLayer& layer, std::size_t block, const std::int8_t* rows, std::size_t row,
                                 const Store& store) {
  const std::size_t stride = RowStride(layer.p.inputs);
  const std::int32_t* bias = layer.p.bias.data() + block * kOutputsPerBlock;
  Tile<R> tile;
  for (std::size_t r = 0; r < R; ++r) {
    tile.sum[r][0] = vld1q_s32(bias);
    tile.sum[r][1] = vld1q_s32(bias + 4);
  }
  Dot::template Add<R>(&tile, layer.p.weights.data() + block * layer.groups() * kGroupBytes, rows + row * stride,
                       stride, layer.groups());
  store.template Put<R>(row, block, tile);
}

template <class Dot, class Store>
MAPWELD_TILE_INLINE void Walk(const LinearLayer& layer, const std::int8_t* rows, std::size_t count,
                              const Store& store) {
  for (std::size_t strip = 0; strip < count; strip += kStripRows) {
    const std::size_t end = strip + kStripRows < count ? strip + kStripRows : count;
    for (std::size_t block = 0; block < layer.blocks(); ++block) {
      std::size_t row = strip;
      for (; row + kTileRows <= end; row += kTileRows) OneTile<Dot, kTileRows>(layer, block, rows, row, store);
      for (; row < end; ++row) OneTile<Dot, 1>(layer, block, rows, row, store);
    }
  }
}

}  // namespace
}  // namespace mapweld::nn
