// SPDX-License-Identifier: Apache-2.0
#include "core/place/descriptor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace mapweld::place {
namespace {

template <std::size_t N>
std::int32_t Dot(const std::array<std::int8_t, N>& a, const std::array<std::int8_t, N>& b) {
  std::int32_t sum = 0;
  for (std::size_t i = 0; i < N; ++i) sum += std::int32_t{a[i]} * std::int32_t{b[i]};
  return sum;
}

// 0 for a vector of zeros, which resembles nothing. sqrt of the exact product, so that equal vectors give exactly 1.
float Cosine(std::int64_t dot, std::int64_t squared_a, std::int64_t squared_b) {
  if (squared_a == 0 || squared_b == 0) return 0;
  const double cosine = static_cast<double>(dot) / std::sqrt(static_cast<double>(squared_a * squared_b));
  return static_cast<float>(std::clamp(cosine, -1.0, 1.0));
}

// The signature is three curves of 64: one over half a turn (it repeats after it), two over the full turn. A step of
// the correlation is 1/128 turn: one element of the first, half an element of the others.
constexpr int kCurve = kSignatureDim / 3;
constexpr int kSteps = 2 * kCurve;

std::int32_t CorrelateCurve(const OrientationSignature& a, const OrientationSignature& b, int curve, int shift) {
  const auto base = static_cast<std::size_t>(curve * kCurve);
  std::int32_t sum = 0;
  for (std::size_t i = 0; i < kCurve; ++i) {
    const std::size_t shifted = (i + static_cast<std::size_t>(shift)) % kCurve;
    sum += std::int32_t{a.q[base + shifted]} * std::int32_t{b.q[base + i]};
  }
  return sum;
}

}  // namespace

float CosineDistance(const PlaceDescriptor& a, const PlaceDescriptor& b) {
  return 1.0F - Cosine(Dot(a.q, b.q), Dot(a.q, a.q), Dot(b.q, b.q));
}

RelativeYaw EstimateRelativeYaw(const OrientationSignature& a, const OrientationSignature& b) {
  std::array<std::int32_t, kCurve> half_turn{};
  std::array<std::int32_t, kCurve> full_turn{};
  for (int s = 0; s < kCurve; ++s) {
    const auto i = static_cast<std::size_t>(s);
    half_turn[i] = CorrelateCurve(a, b, 0, s);
    full_turn[i] = CorrelateCurve(a, b, 1, s) + CorrelateCurve(a, b, 2, s);
  }
  // What b sees at azimuth phi, a sees at phi + yaw; all values doubled so that the mean of two stays an integer.
  const auto doubled = [&half_turn, &full_turn](int step) {
    const auto s = static_cast<std::size_t>(step % kSteps);
    return 2 * half_turn[s % kCurve] + full_turn[s / 2] + full_turn[((s + 1) / 2) % kCurve];
  };
  int peak = 0;
  for (int s = 1; s < kSteps; ++s) {
    if (doubled(s) > doubled(peak)) peak = s;
  }
  // The vertex of the parabola through the peak and its neighbours, within half a step of the peak.
  const std::int32_t before = doubled(peak + kSteps - 1);
  const std::int32_t top = doubled(peak);
  const std::int32_t after = doubled(peak + 1);
  const std::int32_t curvature = 2 * top - before - after;
  const float offset = curvature > 0 ? 0.5F * static_cast<float>(after - before) / static_cast<float>(curvature) : 0.0F;
  float turn = (static_cast<float>(peak) + offset) / static_cast<float>(kSteps);
  if (turn > 0.5F) turn -= 1.0F;
  return {.yaw_rad = turn * 2 * std::numbers::pi_v<float>,
          .score = Cosine(top, 2 * std::int64_t{Dot(a.q, a.q)}, 2 * std::int64_t{Dot(b.q, b.q)})};
}

}  // namespace mapweld::place
