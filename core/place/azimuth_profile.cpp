// SPDX-License-Identifier: Apache-2.0
#include "core/place/azimuth_profile.hpp"

#include <algorithm>
#include <cmath>

#include "core/place/trig_table.hpp"

namespace mapweld::place {
namespace {

constexpr std::int32_t kNearFromQ8 = 5 * kQ8;
constexpr std::int32_t kNearFadeQ8 = 15 * kQ8;  // the near zone fades out from here ...
constexpr std::int32_t kNearEndQ8 = 25 * kQ8;   // ... to here
constexpr std::int32_t kFarFromQ8 = 20 * kQ8;
constexpr std::int32_t kFarEndQ8 = 50 * kQ8;
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
    low += LeftOfRim(low + step, c) >= 0 ? step : 0;
  }
  return low;
}

// One zone's sums; integers, so that the order cannot matter.
struct Zone {
  std::array<std::int64_t, kSectors> sum_q16{};

  void Add(std::size_t before, std::int32_t weight_q8, std::int32_t share_after_q8) {
    sum_q16[before] += weight_q8 * (kQ8 - share_after_q8);
    sum_q16[(before + 1) % kSectors] += weight_q8 * share_after_q8;
  }
  [[nodiscard]] std::array<float, kSectors> Pressed() const {
    std::array<float, kSectors> pressed{};
    for (std::size_t i = 0; i < kSectors; ++i) {
      const float root = std::sqrt(static_cast<float>(sum_q16[i]));
      pressed[i] = root * std::sqrt(root);
    }
    return pressed;
  }
};

}  // namespace

AzimuthProfile MakeAzimuthProfile(const ColumnGrid& grid) {
  Zone near;
  Zone far;
  grid.ForEach([&near, &far](const Column& c) {
    const auto x = static_cast<float>(c.x_q8);
    const auto y = static_cast<float>(c.y_q8);
    const auto r = static_cast<std::int32_t>(std::sqrt(x * x + y * y));
    if (r < kNearFromQ8 || r >= kFarEndQ8) return;
    const std::size_t before = RimBefore(c);
    const auto from_before = static_cast<float>(LeftOfRim(before, c));
    const auto to_after = static_cast<float>(-LeftOfRim((before + 1) % kSectors, c));
    const auto share = static_cast<std::int32_t>(from_before / (from_before + to_after) * static_cast<float>(kQ8));
    if (r < kNearEndQ8) {
      const std::int32_t fade = std::min(kNearEndQ8 - r, kNearEndQ8 - kNearFadeQ8);
      near.Add(before, c.weight_q8 * fade / (kNearEndQ8 - kNearFadeQ8), share);
    }
    if (r >= kFarFromQ8) far.Add(before, c.weight_q8, share);
  });
  return {.near = near.Pressed(), .far = far.Pressed()};
}

}  // namespace mapweld::place
