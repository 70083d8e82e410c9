// SPDX-License-Identifier: Apache-2.0
// Sines and cosines as tables made by the compiler, so that no machine's math library has a say in the descriptor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace mapweld::place {

namespace trig_detail {

// Taylor series, |x| <= pi: the first dropped term is below 1e-14.
constexpr double Sin(double x) {
  double term = x;
  double sum = x;
  for (int n = 1; n <= 14; ++n) {
    term *= -x * x / ((2.0 * n) * (2.0 * n + 1.0));
    sum += term;
  }
  return sum;
}

// pi/2 - |x| brings every |x| <= pi into the half turn around zero.
constexpr double Cos(double x) {
  return Sin(std::numbers::pi / 2 - (x < 0 ? -x : x));
}

}  // namespace trig_detail

// sin and cos of 2 pi i / N for i in 0..N-1.
template <std::size_t N>
struct TrigTable {
  std::array<float, N> sine{};
  std::array<float, N> cosine{};
};

template <std::size_t N>
constexpr TrigTable<N> MakeTrigTable() {
  TrigTable<N> table;
  for (std::size_t i = 0; i < N; ++i) {
    const double turn = static_cast<double>(i) / static_cast<double>(N);
    const double angle = 2 * std::numbers::pi * (turn > 0.5 ? turn - 1 : turn);
    table.sine[i] = static_cast<float>(trig_detail::Sin(angle));
    table.cosine[i] = static_cast<float>(trig_detail::Cos(angle));
  }
  return table;
}

// Unit vectors of 2 pi i / N in parts of 2^14, for integer projections.
inline constexpr int kDirectionShift = 14;
template <std::size_t N>
struct DirectionTable {
  std::array<std::int32_t, N> x{};
  std::array<std::int32_t, N> y{};
};

template <std::size_t N>
constexpr DirectionTable<N> MakeDirectionTable() {
  constexpr auto round = [](float v) {
    const double scaled = static_cast<double>(v) * (1 << kDirectionShift);
    return static_cast<std::int32_t>(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
  };
  constexpr auto trig = MakeTrigTable<N>();
  DirectionTable<N> table;
  for (std::size_t i = 0; i < N; ++i) {
    table.x[i] = round(trig.cosine[i]);
    table.y[i] = round(trig.sine[i]);
  }
  return table;
}

}  // namespace mapweld::place
