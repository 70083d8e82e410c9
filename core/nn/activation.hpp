// SPDX-License-Identifier: Apache-2.0
// Functions of one int8, as tables made by the compiler.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mapweld::nn {

// 128 sigmoid(q / 16), rounded, for q in -127..127 (x within +-7.94): 0 .. 128.
inline constexpr int kGateInputPerUnit = 16;
inline constexpr int kGateOne = 128;

namespace activation_detail {
// exp by its series after halving the argument, in double: the compiler gets the same table everywhere.
constexpr double ExpSeries(double x) {
  double term = 1, sum = 1;
  for (int i = 1; i < 20; ++i) {
    term *= x / 16 / i;
    sum += term;
  }
  for (int i = 0; i < 4; ++i) sum *= sum;
  return sum;
}
constexpr std::array<std::uint8_t, 256> MakeSigmoidTable() {
  std::array<std::uint8_t, 256> table{};
  for (int q = -128; q < 128; ++q) {
    const double sigmoid = 1 / (1 + ExpSeries(-static_cast<double>(q) / kGateInputPerUnit));
    table[static_cast<std::size_t>(q + 128)] = static_cast<std::uint8_t>(kGateOne * sigmoid + 0.5);
  }
  return table;
}
inline constexpr std::array<std::uint8_t, 256> kSigmoid = MakeSigmoidTable();
}  // namespace activation_detail

constexpr std::uint8_t Sigmoid(std::int8_t q) {
  return activation_detail::kSigmoid[static_cast<std::size_t>(q + 128)];
}

}  // namespace mapweld::nn
