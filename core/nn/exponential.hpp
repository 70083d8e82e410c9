// SPDX-License-Identifier: Apache-2.0
// Exponentials that give the same bits on every machine: only +, -, * and exact scaling by powers of two.
#pragma once

#include <bit>
#include <cstdint>

namespace mapweld::nn {

// exp(x) for x in -87..88; the nearer end beyond. Relative error below 1.5e-7 (the test goes through the whole range).
// The result for x <= -87 is 1.6e-38, not 0. Reduction x = n ln 2 + r, |r| <= ln 2 / 2, then the Taylor polynomial of
// degree 7.
constexpr float Exp(float x) {
  x = x < -87.0F ? -87.0F : (x > 88.0F ? 88.0F : x);
  constexpr float kShifter = 12582912.0F;  // 1.5 * 2^23: adding it rounds to the nearest integer
  const float n = (x * 1.44269504F + kShifter) - kShifter;
  float r = x - n * 0.693359375F;  // the upper bits of ln 2, exact times any n here
  r = r - n * -2.12194440e-4F;
  float p = 1.0F / 5040.0F;
  p = p * r + 1.0F / 720.0F;
  p = p * r + 1.0F / 120.0F;
  p = p * r + 1.0F / 24.0F;
  p = p * r + 1.0F / 6.0F;
  p = p * r + 0.5F;
  p = p * r + 1.0F;
  p = p * r + 1.0F;
  return p * std::bit_cast<float>((static_cast<std::int32_t>(n) + 127) * (1 << 23));
}

// 2^15 * 2^(-d / 256) for d >= 0, in integers; within 0.02 % of the true value, then cut off to an integer. 0 from
// d = 16 * 256 on. 2^-f is a cubic polynomial, exact at 0 and 1.
constexpr std::int32_t Exp2Down(std::int32_t d) {
  const std::int32_t capped = d < 4096 ? d : 4096;
  const std::int32_t f = capped & 255;
  const std::int32_t inner = 22642 - ((f * (7520 - ((f * 1262) >> 8))) >> 8);
  return (32768 - ((f * inner) >> 8)) >> (capped >> 8);
}

}  // namespace mapweld::nn
