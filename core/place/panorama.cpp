// SPDX-License-Identifier: Apache-2.0
#include "core/place/panorama.hpp"

#include <algorithm>
#include <cmath>

#include "core/place/azimuth.hpp"

namespace mapweld::place {

void Panorama::Build(std::span<const submap::SubmapPoint> points) {
  for (auto& row : nearness_) row.fill(0);
  for (const submap::SubmapPoint& p : points) {
    const float range = std::sqrt(p.x * p.x + p.y * p.y);
    if (range < 1 || range >= kReach_m) continue;  // nearer than 1 m is the vehicle itself
    const float row = (p.z / range - kLowestSlope) / kSlopeStep;
    if (row < 0 || row >= static_cast<float>(kRows)) continue;
    const auto column = static_cast<std::size_t>(Azimuth(p.x, p.y, kColumns)) % kColumns;
    const auto nearness = static_cast<std::uint8_t>((kReach_m - range) * (127 / kReach_m));
    std::uint8_t& pixel = nearness_[static_cast<std::size_t>(row)][column];
    pixel = std::max(pixel, nearness);
  }
}

}  // namespace mapweld::place
