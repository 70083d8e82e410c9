// SPDX-License-Identifier: Apache-2.0
// What stays of a polar image when the vehicle turns. A turn by psi multiplies angular order k of every ring by
// exp(-2 i k psi): the power of an order does not change, nor does the product of one ring's order with the conjugate
// of another's, which tells how the two are turned against each other.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/place/fft.hpp"

namespace mapweld::place {

inline constexpr std::size_t kAngles = 64;  // samples of a ring

// Orders 0..Orders-1 of two rings at once, scaled by 1 / sqrt(kAngles). One transform of length 64.
template <std::size_t Orders>
void AngularOrders(const std::array<Complex, kAngles>& two_rings, std::array<Complex, Orders>* first,
                   std::array<Complex, Orders>* second) {
  static_assert(Orders <= kAngles / 2);
  std::array<Complex, kAngles> line = two_rings;  // one ring as the real part, the other as the imaginary one
  Fft<kAngles>(line);
  constexpr float kScale = 0.5F / 8.0F;
  for (std::size_t k = 0; k < Orders; ++k) {
    const Complex& plus = line[k];
    const Complex& minus = line[(kAngles - k) % kAngles];
    (*first)[k] = {kScale * (plus.re + minus.re), kScale * (plus.im - minus.im)};
    (*second)[k] = {kScale * (plus.im + minus.im), kScale * (minus.re - plus.re)};
  }
}

// (|c|^2 + 1e-6)^(3/8), by square roots only because those round the same way everywhere.
inline float PressedPower(const Complex& c) {
  const float root8 = std::sqrt(std::sqrt(std::sqrt(c.re * c.re + c.im * c.im + 1e-6F)));
  return root8 * root8 * root8;
}

// a conj(b), its amplitude pressed to the fourth root.
inline Complex PressedRelation(const Complex& a, const Complex& b) {
  const Complex product{a.re * b.re + a.im * b.im, a.im * b.re - a.re * b.im};
  const float pressed = PressedPower(product);
  return {product.re / pressed, product.im / pressed};
}

}  // namespace mapweld::place
