// SPDX-License-Identifier: Apache-2.0
#include "core/place/azimuth_profile.hpp"

#include <algorithm>
#include <cmath>

#include "core/place/azimuth.hpp"

namespace mapweld::place {
namespace {

constexpr std::int32_t kNearFromQ8 = 5 * kQ8;
constexpr std::int32_t kNearFadeQ8 = 15 * kQ8;  // the near zone fades out from here ...
constexpr std::int32_t kNearEndQ8 = 25 * kQ8;   // ... to here
constexpr std::int32_t kFarFromQ8 = 20 * kQ8;
constexpr std::int32_t kFarEndQ8 = 50 * kQ8;

// Azimuth in sectors times 256, 0..kSectors * 256.
std::int32_t AzimuthQ8(const Column& c) {
  return static_cast<std::int32_t>(
      Azimuth(static_cast<float>(c.x_q8), static_cast<float>(c.y_q8), static_cast<float>(kSectors) * kQ8));
}

}  // namespace

void AzimuthProfile::Clear() {
  near_q16_.fill(0);
  far_q16_.fill(0);
}

void AzimuthProfile::Add(const Column& column) {
  const std::int32_t r = column.range_q8;
  if (r < kNearFromQ8 || r >= kFarEndQ8) return;
  const std::int32_t azimuth_q8 = AzimuthQ8(column);
  const std::size_t before = static_cast<std::size_t>(azimuth_q8 / kQ8) % kSectors;
  const std::size_t after = (before + 1) % kSectors;
  const std::int32_t share = azimuth_q8 % kQ8;
  if (r < kNearEndQ8) {
    const std::int32_t fade = std::min(kNearEndQ8 - r, kNearEndQ8 - kNearFadeQ8);
    const std::int32_t weight = column.weight_q8 * fade / (kNearEndQ8 - kNearFadeQ8);
    near_q16_[before] += weight * (kQ8 - share);
    near_q16_[after] += weight * share;
  }
  if (r >= kFarFromQ8) {
    far_q16_[before] += column.weight_q8 * (kQ8 - share);
    far_q16_[after] += column.weight_q8 * share;
  }
}

std::array<float, kSectors> AzimuthProfile::Pressed(const Sums& sums) {
  std::array<float, kSectors> pressed{};
  for (std::size_t i = 0; i < kSectors; ++i) {
    const float root = std::sqrt(static_cast<float>(sums[i]));
    pressed[i] = root * std::sqrt(root);
  }
  return pressed;
}

}  // namespace mapweld::place
