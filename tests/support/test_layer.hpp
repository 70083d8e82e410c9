// SPDX-License-Identifier: Apache-2.0
// Layers and activations made up for tests and benchmarks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "core/nn/linear.hpp"

namespace mapweld::nn {

enum class Fill { kRandom, kExtreme, kNarrow };

// A layer with the memory that it points to.
class TestLayer {
 public:
  // fill: kRandom, any weights; kExtreme, only +-127 and biases at their limits; kNarrow, what keeps layer().narrow.
  TestLayer(std::size_t inputs, std::size_t outputs, Fill fill, std::int32_t lowest, std::mt19937* random)
      : weights_(PackedBytes(outputs, inputs)),
        bias_(SumStride(outputs)),
        multiplier_(SumStride(outputs), 1 << 30),
        shift_(SumStride(outputs), 32) {
    const int limit = fill == Fill::kNarrow ? 64 : 127;
    std::uniform_int_distribution<int> weight(-limit, limit);
    std::uniform_int_distribution<std::int32_t> bias(-100000, 100000), multiplier(1 << 30, 2147483647), shift(38, 48);
    for (std::size_t n = 0; n < outputs; ++n) {
      for (std::size_t k = 0; k < inputs; ++k) {
        int w = weight(*random);
        if (fill == Fill::kExtreme) w = w < 0 ? -127 : 127;
        weights_[Index(n, k, inputs)] = static_cast<std::int8_t>(w);
      }
      bias_[n] = bias(*random);
      multiplier_[n] = multiplier(*random);
      shift_[n] = shift(*random);
      if (fill == Fill::kExtreme) {
        bias_[n] = bias_[n] < 0 ? -(1 << 30) : 1 << 30;
        multiplier_[n] = multiplier_[n] % 2 == 0 ? 1 << 30 : 2147483647;
        shift_[n] = shift_[n] % 3 == 0 ? 32 : 62;
      }
    }
    parameters = {inputs, outputs, weights_, bias_, multiplier_, shift_, lowest};
  }
  TestLayer(const TestLayer&) = delete;
  TestLayer& operator=(const TestLayer&) = delete;

  static std::size_t Index(std::size_t n, std::size_t k, std::size_t inputs) {
    return ((n / 8 * (RowStride(inputs) / 4) + k / 4) * 8 + n % 8) * 4 + k % 4;
  }
  [[nodiscard]] LinearLayer layer() const { return MakeLinear(parameters).value(); }

  LinearParameters parameters;

 private:
  std::vector<std::int8_t> weights_;
  std::vector<std::int32_t> bias_, multiplier_, shift_;
};

// Rows in lowest..127 (extreme: only lowest and 127), zeros behind the inputs.
inline std::vector<std::int8_t> TestRows(std::size_t count, std::size_t inputs, int lowest, bool extreme,
                                         std::mt19937* random) {
  std::uniform_int_distribution<int> value(lowest, 127);
  std::vector<std::int8_t> rows(count * RowStride(inputs));
  for (std::size_t m = 0; m < count; ++m) {
    for (std::size_t k = 0; k < inputs; ++k) {
      const int v = value(*random);
      rows[m * RowStride(inputs) + k] = static_cast<std::int8_t>(extreme ? (v % 2 == 0 ? lowest : 127) : v);
    }
  }
  return rows;
}

}  // namespace mapweld::nn
