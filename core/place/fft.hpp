// SPDX-License-Identifier: Apache-2.0
// A small in-place complex FFT. The order of the operations is fixed, so the same input gives the same bits everywhere.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <utility>

#include "core/place/trig_table.hpp"

namespace mapweld::place {

struct Complex {
  float re = 0;
  float im = 0;
};

// X[k] = sum_n x[n] exp(-2 pi i k n / N), unscaled. Radix 2, decimation in time; 5 N log2 N flops.
template <std::size_t N>
void Fft(std::span<Complex, N> x) {
  static_assert(std::has_single_bit(N) && N >= 2);
  static constexpr auto kTrig = MakeTrigTable<N>();
  for (std::size_t i = 1, j = 0; i < N; ++i) {
    std::size_t bit = N >> 1U;
    for (; (j & bit) != 0; bit >>= 1U) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t half = 1; half < N; half *= 2) {
    const std::size_t stride = N / (2 * half);
    for (std::size_t start = 0; start < N; start += 2 * half) {
      for (std::size_t k = 0; k < half; ++k) {
        const float c = kTrig.cosine[k * stride];
        const float s = -kTrig.sine[k * stride];
        Complex& a = x[start + k];
        Complex& b = x[start + k + half];
        const Complex t{b.re * c - b.im * s, b.re * s + b.im * c};
        b = {a.re - t.re, a.im - t.im};
        a = {a.re + t.re, a.im + t.im};
      }
    }
  }
}

}  // namespace mapweld::place
