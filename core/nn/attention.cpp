// SPDX-License-Identifier: Apache-2.0
#include "core/nn/attention.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/assert.hpp"
#include "core/nn/activation.hpp"
#include "core/nn/exponential.hpp"

namespace mapweld::nn {
namespace {

// Sums are taken in eight lanes, then over the lanes, so that the order is the same with and without vector
// instructions.
constexpr std::size_t kLanes = 8;

}  // namespace

void SelfAttention(std::span<const float> v, float gamma, std::span<float> row, std::span<float> out) {
  const std::size_t channels = v.size();
  MAPWELD_ASSERT(channels % kLanes == 0 && row.size() >= channels && out.size() == channels && out.data() != v.data());
  std::copy(v.begin(), v.end(), out.begin());
  if (channels == 0) return;
  const auto [smallest, largest] = std::minmax_element(v.begin(), v.end());
  for (std::size_t i = 0; i < channels; ++i) {
    const float top = v[i] > 0 ? v[i] * *largest : v[i] * *smallest;  // the largest v_i v_j
    std::array<float, kLanes> sums{};
    for (std::size_t j = 0; j < channels; j += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const float e = Exp(v[i] * v[j + lane] - top);
        row[j + lane] = e;
        sums[lane] += e;
      }
    }
    float sum = 0;
    for (const float s : sums) sum += s;
    const float factor = gamma * v[i] / sum;
    for (std::size_t j = 0; j < channels; ++j) out[j] += factor * row[j];
  }
}

void Gate(const Kernels& kernels, const LinearLayer& layer, const std::int8_t* v, std::int8_t* gate, std::int8_t* out) {
  MAPWELD_ASSERT(layer.p.inputs == layer.p.outputs);
  kernels.linear(layer, v, 1, gate);
  for (std::size_t c = 0; c < layer.p.outputs; ++c) {
    out[c] = static_cast<std::int8_t>((v[c] * Sigmoid(gate[c]) + kGateOne / 2) >> 7);
  }
}

}  // namespace mapweld::nn
