// SPDX-License-Identifier: Apache-2.0
// A submap as a plan view: how much structure stands on each 0.5 m x 0.5 m cell. A point counts by its height over the
// lowest point within one cell of its own: nothing has to know the ground, so neither a slope, nor missing ground, nor
// the mounting height of the sensor matters, and flat ground itself weighs little. Cells keep the sum and the centre of
// the weights, so that a turn of the submap moves the view and hardly changes it. Everything is integer sums and
// minima: the order of the points cannot matter.
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
  std::int32_t x_q8 = 0;  // centre of the weights, level frame
  std::int32_t y_q8 = 0;
  std::int32_t range_q8 = 0;   // from the vehicle, rounded down
  std::int32_t weight_q8 = 0;  // points, each between kLowestWeightQ8 and 1; at most kMaxWeightQ8
  std::int32_t tall_q8 = 0;    // of them, those at least kTallHeightQ8 over their surroundings
  std::int32_t high_q8 = 0;    // and those at least kHighHeightQ8
};

class ColumnGrid {
 public:
  static constexpr std::int32_t kCellQ8 = kQ8 / 2;
  static constexpr std::int32_t kReachQ8 = 50 * kQ8;        // cells cover |x|, |y| < 50 m
  static constexpr std::int32_t kLowestWeightQ8 = kQ8 / 4;  // of a point that has nothing below it
  static constexpr std::int32_t kFullHeightQ8 = kQ8 / 2;    // a point this high over its surroundings counts in full
  static constexpr std::int32_t kTallHeightQ8 = kQ8;        // walls, hedges, vehicles: not kerbs
  static constexpr std::int32_t kHighHeightQ8 = 3 * kQ8;    // houses, trees, poles: not vehicles
  static constexpr std::int32_t kTopHeightQ8 = 8 * kQ8;     // one this high counts no more: not every sensor sees it
  static constexpr std::int32_t kMaxWeightQ8 = 32 * kQ8;    // of a cell
  static constexpr float kMaxCoordinate_m = 1000.0F;

  // kBadInput: a point that is not finite or farther than kMaxCoordinate_m from the origin, fewer than min_points
  // points within reach, or all of them in one plane or line to within 5 cm. Cost: one pass over the points.
  Status Build(std::span<const submap::SubmapPoint> points, std::size_t min_points);

  // Calls visit(Column) for every occupied cell, in a fixed order. At most kSide * kSide cells.
  template <class Visitor>
  void ForEach(Visitor visit) const {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (cells_[i].weight_q8 > 0) visit(MakeColumn(i));
    }
  }

 private:
  static constexpr std::size_t kSide = 2 * kReachQ8 / kCellQ8;
  static constexpr std::int32_t kEmptyQ8 = INT32_MAX;
  struct Cell {
    std::int32_t lowest_q8 = kEmptyQ8;         // in this cell
    std::int32_t lowest_around_q8 = kEmptyQ8;  // in this cell and its eight neighbours, once asked for
    std::int32_t weight_q8 = 0;
    std::int32_t tall_q8 = 0;
    std::int32_t high_q8 = 0;
    std::int32_t x_moment_q16 = 0;  // sum of weight times the place inside the cell
    std::int32_t y_moment_q16 = 0;
  };
  static_assert(std::int64_t{kCap.submap_points} * kQ8 * kCellQ8 < INT32_MAX);

  struct Place {
    std::int32_t x_q8 = 0;
    std::int32_t y_q8 = 0;
    std::int32_t z_q8 = 0;
    bool is_inside = false;
    std::size_t cell = 0;  // valid if inside
  };
  static Place MakePlace(const submap::SubmapPoint& p);
  [[nodiscard]] std::int32_t LowestAround(std::size_t index) const;
  [[nodiscard]] Column MakeColumn(std::size_t index) const;

  std::array<Cell, kSide * kSide> cells_;  // 1120 kB
};

}  // namespace mapweld::place
