// SPDX-License-Identifier: Apache-2.0
// A submap as a plan view: how tall the structure over each 0.5 m x 0.5 m cell is. The height is that of the points
// above one another, not above the ground, so that neither a slope, nor missing ground, nor a change of the sensor's
// mounting height matters; flat ground itself weighs next to nothing. Everything is integer minima and maxima, so the
// order of the points cannot matter.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/submap/submap.hpp"

namespace mapweld::place {

// Lengths inside are in 1/256 m ("q8").
inline constexpr int kQ8 = 256;

struct Column {
  std::int32_t x_q8 = 0;  // middle of the points in the cell, level frame
  std::int32_t y_q8 = 0;
  std::int32_t weight_q8 = 0;  // height of the structure plus kBaseWeight, at most kMaxWeight
};

class ColumnGrid {
 public:
  static constexpr std::int32_t kCellQ8 = kQ8 / 2;
  static constexpr std::int32_t kReachQ8 = 50 * kQ8;  // cells cover |x|, |y| < 50 m
  static constexpr std::int32_t kBaseWeightQ8 = kQ8 / 4;
  static constexpr std::int32_t kMaxWeightQ8 = 8 * kQ8;
  static constexpr float kMaxCoordinate_m = 1000.0F;

  // kBadInput: a point that is not finite or farther than kMaxCoordinate_m from the origin, fewer than min_points
  // points within reach, or all of them in one plane or line to within 5 cm. Cost: one pass over the points.
  Status Build(std::span<const submap::SubmapPoint> points, std::size_t min_points);

  // Calls visit(Column) for every occupied cell, in a fixed order. At most kSide * kSide cells.
  template <class Visitor>
  void ForEach(Visitor visit) const {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (cells_[i].z_max_q8 >= cells_[i].z_min_q8) visit(MakeColumn(i));
    }
  }

 private:
  static constexpr std::size_t kSide = 2 * kReachQ8 / kCellQ8;
  struct Cell {
    std::int32_t z_min_q8 = 1;
    std::int32_t z_max_q8 = 0;  // below z_min_q8: empty
    std::uint8_t x_min_q8 = 0;  // inside the cell, 0..kCellQ8 - 1
    std::uint8_t x_max_q8 = 0;
    std::uint8_t y_min_q8 = 0;
    std::uint8_t y_max_q8 = 0;
  };
  [[nodiscard]] Column MakeColumn(std::size_t index) const;

  std::array<Cell, kSide * kSide> cells_;  // 480 kB
};

}  // namespace mapweld::place
