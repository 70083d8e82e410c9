// SPDX-License-Identifier: Apache-2.0
// How much structure stands in each of 64 azimuth sectors around the vehicle. Coarser than the spectrum, but unlike it
// not the same after half a turn.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/place/column_grid.hpp"

namespace mapweld::place {

inline constexpr std::size_t kSectors = 64;

// Clear, then Add every column of a view. The order of the columns does not matter.
class AzimuthProfile {
 public:
  // Columns within 5 m of the vehicle and beyond 50 m are left out: the azimuth of the near ones depends on the lane.
  void Add(const Column& column);
  void Clear();

  // Two zones, because a step along the street turns near things a lot and far things a little: from 5 m to a soft end
  // at 15..25 m, and from 20 m to 50 m. Summed weights to the power of 3/4; element i is about azimuth 2 pi i / 64.
  [[nodiscard]] std::array<float, kSectors> Near() const { return Pressed(near_q16_); }
  [[nodiscard]] std::array<float, kSectors> Far() const { return Pressed(far_q16_); }

 private:
  using Sums = std::array<std::int64_t, kSectors>;
  static std::array<float, kSectors> Pressed(const Sums& sums);

  Sums near_q16_{};
  Sums far_q16_{};
};

}  // namespace mapweld::place
