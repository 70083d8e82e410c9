// SPDX-License-Identifier: Apache-2.0
#include "core/nn/linear.hpp"

#include <array>

namespace mapweld::nn {
namespace {

constexpr std::int32_t kMaxBias = 1 << 30;
constexpr std::int32_t kMinMultiplier = 1 << 30;
constexpr int kNarrowSum = 258;
static_assert(kNarrowSum * 127 <= 32767);
static_assert(std::int64_t{kMaxInputs} * 127 * 127 + kMaxBias <= 2147483647);

std::int8_t Weight(const LinearLayer& layer, std::size_t output, std::size_t input) {
  const std::size_t block = output / kOutputsPerBlock;
  const std::size_t group = block * layer.groups() + input / kInputsPerGroup;
  return layer.p
      .weights[(group * kOutputsPerBlock + output % kOutputsPerBlock) * kInputsPerGroup + input % kInputsPerGroup];
}

int Magnitude(const LinearLayer& layer, std::size_t output, std::size_t input) {
  const int w = Weight(layer, output, input);
  return w < 0 ? -w : w;
}

bool WeightsInRange(const LinearLayer& layer) {
  for (const std::int8_t w : layer.p.weights) {
    if (w == -128) return false;
  }
  const std::size_t all_outputs = SumStride(layer.p.outputs);
  const std::size_t all_inputs = RowStride(layer.p.inputs);
  for (std::size_t n = 0; n < all_outputs; ++n) {
    const std::size_t padded_from = n < layer.p.outputs ? layer.p.inputs : 0;
    for (std::size_t k = padded_from; k < all_inputs; ++k) {
      if (Weight(layer, n, k) != 0) return false;
    }
  }
  return true;
}

bool IsNarrow(const LinearLayer& layer) {
  for (std::size_t n = 0; n < layer.p.outputs; ++n) {
    for (std::size_t group = 0; group + 1 < layer.groups(); group += 2) {
      for (std::size_t half = 0; half < kInputsPerGroup; half += 2) {
        const std::size_t k = group * kInputsPerGroup + half;
        const int sum = Magnitude(layer, n, k) + Magnitude(layer, n, k + 1) + Magnitude(layer, n, k + kInputsPerGroup) +
                        Magnitude(layer, n, k + kInputsPerGroup + 1);
        if (sum > kNarrowSum) return false;
      }
    }
  }
  return true;
}

bool NumbersInRange(const LinearParameters& p) {
  for (std::size_t n = 0; n < SumStride(p.outputs); ++n) {
    const bool padding = n >= p.outputs;
    if (p.bias[n] > (padding ? 0 : kMaxBias) || p.bias[n] < (padding ? 0 : -kMaxBias)) return false;
    if (p.multiplier.empty()) continue;
    if (p.multiplier[n] < kMinMultiplier || p.shift[n] < 32 || p.shift[n] > 62) return false;
  }
  return p.lowest == 0 || p.lowest == -127;
}

// The sums of one row for eight outputs.
std::array<std::int32_t, kOutputsPerBlock> BlockSums(const LinearLayer& layer, std::size_t block,
                                                     const std::int8_t* row) {
  std::array<std::int32_t, kOutputsPerBlock> sums{};
  for (std::size_t i = 0; i < kOutputsPerBlock; ++i) sums[i] = layer.p.bias[block * kOutputsPerBlock + i];
  const std::int8_t* w = layer.p.weights.data() + block * layer.groups() * kOutputsPerBlock * kInputsPerGroup;
  for (std::size_t group = 0; group < layer.groups(); ++group) {
    for (std::size_t i = 0; i < kOutputsPerBlock; ++i) {
      for (std::size_t k = 0; k < kInputsPerGroup; ++k) sums[i] += row[k] * w[i * kInputsPerGroup + k];
    }
    row += kInputsPerGroup;
    w += kOutputsPerBlock * kInputsPerGroup;
  }
  return sums;
}

}  // namespace

Result<LinearLayer> MakeLinear(const LinearParameters& parameters) {
  const LinearParameters& p = parameters;
  if (p.inputs == 0 || p.inputs > kMaxInputs || p.outputs == 0 || p.outputs > kMaxInputs) return Status::kBadInput;
  const std::size_t padded = SumStride(p.outputs);
  if (p.weights.size() != PackedBytes(p.outputs, p.inputs) || p.bias.size() != padded) return Status::kBadInput;
  if (p.multiplier.size() != p.shift.size()) return Status::kBadInput;
  if (!p.multiplier.empty() && p.multiplier.size() != padded) return Status::kBadInput;
  LinearLayer layer{p, false};
  if (!WeightsInRange(layer) || !NumbersInRange(p)) return Status::kOutOfRange;
  layer.narrow = IsNarrow(layer);
  return layer;
}

void LinearPortable(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int8_t* out) {
  const std::size_t out_stride = RowStride(layer.p.outputs);
  for (std::size_t m = 0; m < count; ++m) {
    const std::int8_t* row = rows + m * RowStride(layer.p.inputs);
    for (std::size_t block = 0; block < layer.blocks(); ++block) {
      const auto sums = BlockSums(layer, block, row);
      const std::size_t first = block * kOutputsPerBlock;
      for (std::size_t n = first; n < std::min(first + kOutputsPerBlock, out_stride); ++n) {
        out[m * out_stride + n] = Requantize(sums[n - first], layer.p.multiplier[n], layer.p.shift[n], layer.p.lowest);
      }
    }
  }
}

void LinearSumsPortable(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int32_t* out) {
  for (std::size_t m = 0; m < count; ++m) {
    const std::int8_t* row = rows + m * RowStride(layer.p.inputs);
    for (std::size_t block = 0; block < layer.blocks(); ++block, out += kOutputsPerBlock) {
      const auto sums = BlockSums(layer, block, row);
      std::copy(sums.begin(), sums.end(), out);
    }
  }
}

}  // namespace mapweld::nn
