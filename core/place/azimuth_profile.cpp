// SPDX-License-Identifier: Apache-2.0
#include "core/place/azimuth_profile.hpp"

#include <cmath>

#include "core/place/trig_table.hpp"

namespace mapweld::place {
namespace {

constexpr std::int32_t kNearQ8 = 5 * kQ8;
constexpr std::int32_t kFarQ8 = 50 * kQ8;
constexpr std::int32_t kFadeFromQ8 = 40 * kQ8;
constexpr std::int32_t kFadeQ8 = 20 * kQ8;
constexpr auto kDirection = MakeDirectionTable<kSectors>();

// Twice the area of the triangle between rim i and the point: positive when the point lies to its left.
std::int32_t LeftOfRim(std::size_t i, const Column& c) {
  return kDirection.x[i] * c.y_q8 - kDirection.y[i] * c.x_q8;
}

// The rim at or just before the point, anticlockwise. A binary search, because a library's atan2 may differ between
// machines.
std::size_t RimBefore(const Column& c) {
  const bool upper_half = c.y_q8 > 0 || (c.y_q8 == 0 && c.x_q8 > 0);
  std::size_t low = upper_half ? 0 : kSectors / 2;
  for (std::size_t step = kSectors / 4; step > 0; step /= 2) {
    if (LeftOfRim(low + step, c) >= 0) low += step;
  }
  return low;
}

}  // namespace

std::array<float, kSectors> AzimuthProfile(const ColumnGrid& grid) {
  std::array<std::int64_t, kSectors> sum_q16{};
  grid.ForEach([&sum_q16](const Column& c) {
    const auto x = static_cast<float>(c.x_q8);
    const auto y = static_cast<float>(c.y_q8);
    const auto r = static_cast<std::int32_t>(std::sqrt(x * x + y * y));
    if (r < kNearQ8 || r >= kFarQ8) return;
    const std::int32_t weight = r <= kFadeFromQ8 ? c.weight_q8 : c.weight_q8 * (kFadeFromQ8 + kFadeQ8 - r) / kFadeQ8;
    const std::size_t before = RimBefore(c);
    const std::size_t after = (before + 1) % kSectors;
    const std::int64_t from_before = LeftOfRim(before, c);
    const std::int64_t to_after = -std::int64_t{LeftOfRim(after, c)};
    const auto share = static_cast<std::int32_t>(from_before * kQ8 / (from_before + to_after));
    sum_q16[before] += weight * (kQ8 - share);
    sum_q16[after] += weight * share;
  });
  std::array<float, kSectors> profile{};
  for (std::size_t i = 0; i < kSectors; ++i) profile[i] = std::sqrt(static_cast<float>(sum_q16[i]));
  return profile;
}

}  // namespace mapweld::place
