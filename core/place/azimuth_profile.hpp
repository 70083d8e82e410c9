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

// Two zones, because a step along the street turns near things a lot and far things a little.
struct AzimuthProfile {
  std::array<float, kSectors> near{};  // from 5 m to a soft end at 15..25 m
  std::array<float, kSectors> far{};   // from 20 m to 50 m
};

// The summed weights to the power of 3/4, shared between the two nearest rims; rim i lies at azimuth 2 pi i / 64.
// Columns within 5 m of the vehicle are left out: their azimuth depends on the lane. One pass over the columns.
AzimuthProfile MakeAzimuthProfile(const ColumnGrid& grid);

}  // namespace mapweld::place
