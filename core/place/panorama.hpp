// SPDX-License-Identifier: Apache-2.0
// A submap as seen from the vehicle: how near the nearest structure is, by azimuth and by slope.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/submap/submap.hpp"

namespace mapweld::place {

// Columns are azimuth sectors over a full turn (a turn of the vehicle shifts them), rows are slopes z / horizontal range
// from kLowestSlope upwards in equal steps.
class Panorama {
 public:
  static constexpr std::size_t kColumns = 64;
  static constexpr std::size_t kRows = 32;
  static constexpr float kLowestSlope = -0.5F;
  static constexpr float kSlopeStep = 1.5F / kRows;
  static constexpr float kReach_m = 50;

  // One pass over the points; their order does not matter. Points must be finite.
  void Build(std::span<const submap::SubmapPoint> points);

  // 127 at the vehicle to 0 at kReach_m and where nothing is seen.
  [[nodiscard]] std::uint8_t At(std::size_t row, std::size_t column) const { return nearness_[row][column]; }

 private:
  std::array<std::array<std::uint8_t, kColumns>, kRows> nearness_;
};

}  // namespace mapweld::place
