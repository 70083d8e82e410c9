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

// Square root of the summed weights, shared between the two nearest sector rims; rim i lies at azimuth 2 pi i / 64.
// Columns within 5 m of the vehicle are left out: their azimuth changes too fast with the lane. One pass over the
// columns.
std::array<float, kSectors> AzimuthProfile(const ColumnGrid& grid);

}  // namespace mapweld::place
