// SPDX-License-Identifier: Apache-2.0
// NetVLAD pooling (Arandjelovic et al., CVPR 2016): the rows of a place, in any order and number, to one vector
//   V[k][c] = sum over rows of a[row][k] (x[row][c] - centre[k][c]),  a = softmax over k of a linear layer,
// each V[k] scaled to length 1, then all together. Rows come in blocks, so that the layer before it can work block by
// block and its activations never leave the nearest cache.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/nn/kernels.hpp"

namespace mapweld::nn {

struct NetVladParameters {
  LinearParameters assign;         // channels -> clusters (at most 64), sums only: no multiplier, no shift
  LogitScale logit;                // of those sums
  std::span<const float> centres;  // [clusters][channels], in the units of the rows' int8
  float output_scale = 0;          // output = V / output_scale, rounded, clamped to -127..127
};

struct NetVladLayer {
  LinearLayer assign;
  LogitScale logit;
  std::span<const float> centres;
  float output_scale = 0;

  [[nodiscard]] std::size_t channels() const { return assign.p.inputs; }
  [[nodiscard]] std::size_t clusters() const { return assign.p.outputs; }
};
// kBadInput: sizes; kOutOfRange: numbers (as MakeLinear; centres and scale must be finite, the scale positive).
Result<NetVladLayer> MakeNetVlad(const NetVladParameters& parameters);

class NetVlad {
 public:
  static constexpr std::size_t kBlockRows = kPackedRows;
  static constexpr std::size_t kMaxRows = 65536;  // keeps sums within 32 bits
  // 32-bit words of working memory.
  static constexpr std::size_t Words(std::size_t channels, std::size_t clusters) {
    return 2 * clusters * SumStride(channels) + SumStride(channels) + SumStride(clusters) +
           kBlockRows * SumStride(clusters) + (PackedRowsBytes(channels) + clusters * kBlockRows) / 4;
  }

  // memory: at least Words(), whatever is in it. The layer's arrays and the memory must outlive this.
  NetVlad(const NetVladLayer& layer, const Kernels& kernels, std::span<std::int32_t> memory);

  void Begin();
  // rows: [count][RowStride(channels)], count <= kBlockRows. kFull: more than kMaxRows in all, and the block is left
  // out. 4 * count * channels * clusters operations.
  Status AddBlock(const std::int8_t* rows, std::size_t count);
  // out: [clusters][channels], without gaps. A cluster that no row belongs to gives zeros. kEmpty when there were no
  // rows at all.
  Status Finish(std::int8_t* out);

 private:
  const NetVladLayer layer_;
  const Kernels& kernels_;
  std::span<std::int32_t> sums_;         // [clusters][SumStride(channels)], of all blocks
  std::span<std::int32_t> block_sums_;   // of one block
  std::span<std::int32_t> no_bias_;      // [SumStride(channels)]
  std::span<std::int32_t> share_sums_;   // [clusters]
  std::span<std::int32_t> assign_sums_;  // [kBlockRows][SumStride(clusters)]
  std::int8_t* packed_ = nullptr;        // a block's rows as weights: rows are the inputs, channels the outputs
  std::int8_t* shares_ = nullptr;        // [clusters][kBlockRows]
  std::size_t rows_ = 0;
};

}  // namespace mapweld::nn
