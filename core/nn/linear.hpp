// SPDX-License-Identifier: Apache-2.0
// A fully connected layer on int8 rows; a 1 x 1 convolution is the same thing. docs/model_format.md has the numbers'
// rules.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"

namespace mapweld::nn {

inline constexpr std::size_t kOutputsPerBlock = 8;  // of packed weights
inline constexpr std::size_t kInputsPerGroup = 4;
inline constexpr std::size_t kMaxInputs = 65536;  // of one output: its sum cannot overflow

constexpr std::size_t RoundUp(std::size_t n, std::size_t to) {
  return (n + to - 1) / to * to;
}
// Bytes from one row of activations to the next; those behind the channels are zero.
constexpr std::size_t RowStride(std::size_t channels) {
  return RoundUp(channels, kInputsPerGroup);
}
// Numbers from one row of sums to the next; also the length of a layer's bias, multiplier and shift.
constexpr std::size_t SumStride(std::size_t outputs) {
  return RoundUp(outputs, kOutputsPerBlock);
}
constexpr std::size_t PackedBytes(std::size_t outputs, std::size_t inputs) {
  return SumStride(outputs) * RowStride(inputs);
}

// The one rounding rule of all layers: floor(sum * multiplier / 2^shift + 1/2), exact in 64 bits; with a shift of 32 to
// 62 the result is within +-2^30.
inline std::int32_t ScaleSum(std::int32_t sum, std::int32_t multiplier, std::int32_t shift) {
  const std::int64_t product = std::int64_t{sum} * multiplier;
  return static_cast<std::int32_t>((product + (std::int64_t{1} << (shift - 1))) >> shift);
}
inline std::int8_t Requantize(std::int32_t sum, std::int32_t multiplier, std::int32_t shift, std::int32_t lowest) {
  return static_cast<std::int8_t>(std::clamp<std::int32_t>(ScaleSum(sum, multiplier, shift), lowest, 127));
}

// What a layer is made of, as the model blob holds it. Behind the last output all arrays are padded: weights and bias
// with 0, multiplier with 2^30, shift with 32. A layer whose sums are the result has no multiplier and no shift.
struct LinearParameters {
  std::size_t inputs = 0;
  std::size_t outputs = 0;
  std::span<const std::int8_t> weights;      // packed, see docs/model_format.md
  std::span<const std::int32_t> bias;        // within +-2^30
  std::span<const std::int32_t> multiplier;  // 2^30 .. 2^31 - 1
  std::span<const std::int32_t> shift;       // 32 .. 62
  std::int32_t lowest = 0;                   // 0: ReLU; -127: none
};

// A layer that was checked. Small and cheap to copy; the arrays must outlive it.
struct LinearLayer {
  LinearParameters p;
  // In every output four neighbouring pairs' magnitudes sum up to at most 258, so that two 16-bit products of a kernel
  // fit into one 16-bit sum (258 * 127 < 2^15). The trainer's quantiser sees to it; without it some kernels take a
  // third longer.
  bool narrow = false;

  [[nodiscard]] std::size_t groups() const { return RowStride(p.inputs) / kInputsPerGroup; }
  [[nodiscard]] std::size_t blocks() const { return SumStride(p.outputs) / kOutputsPerBlock; }
};

// kBadInput: sizes that do not fit each other; kOutOfRange: a number outside its range above, or padding that is not as
// it should be. One pass over the weights.
Result<LinearLayer> MakeLinear(const LinearParameters& parameters);

// rows: [count][RowStride(inputs)], values in -127..127, zeros behind the inputs. out: [count][RowStride(outputs)],
// zeros behind the outputs. 2 * count * inputs * outputs operations. The same bytes from every kernel.
using LinearFunction = void (*)(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int8_t* out);
// The sums themselves, out: [count][SumStride(outputs)].
using LinearSumsFunction = void (*)(const LinearLayer& layer, const std::int8_t* rows, std::size_t count,
                                    std::int32_t* out);

// The plain reference.
void LinearPortable(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int8_t* out);
void LinearSumsPortable(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int32_t* out);

}  // namespace mapweld::nn
