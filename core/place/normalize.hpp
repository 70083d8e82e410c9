// SPDX-License-Identifier: Apache-2.0
// Bringing blocks of features to a common size and into int8.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace mapweld::place {

// Scales `values` to the given length; all zeros stay all zeros.
inline void ScaleToLength(std::span<float> values, float length) {
  float squared = 0;
  for (const float v : values) squared += v * v;
  if (squared <= 0) return;
  const float factor = length / std::sqrt(squared);
  for (float& v : values) v *= factor;
}

inline void SubtractMean(std::span<float> values) {
  float sum = 0;
  for (const float v : values) sum += v;
  const float mean = sum / static_cast<float>(values.size());
  for (float& v : values) v -= mean;
}

// Rounds to -127..127 with the largest magnitude at 127; gives the scale with value ~ scale * q.
template <std::size_t N>
float QuantizeToInt8(const std::array<float, N>& values, std::array<std::int8_t, N>* q) {
  float largest = 0;
  for (const float v : values) largest = std::max(largest, std::abs(v));
  if (largest <= 0) {
    q->fill(0);
    return 0;
  }
  for (std::size_t i = 0; i < N; ++i) {
    (*q)[i] = static_cast<std::int8_t>(std::floor(values[i] / largest * 127.0F + 0.5F));
  }
  return largest / 127.0F;
}

}  // namespace mapweld::place
