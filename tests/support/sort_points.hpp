// SPDX-License-Identifier: Apache-2.0
// Submaps made up by tests, with their points in the order that RollingMap gives them and the encoder wants.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/submap/submap_grid.hpp"

namespace mapweld::test {

// Points outside the grid count as cell 0.
inline void SortPoints(submap::Submap* submap) {
  const auto key = [&](const submap::SubmapPoint& p) {
    std::uint32_t cell = 0;
    return submap::CellKey(p, submap->voxel_m, &cell) ? cell : 0;
  };
  std::sort(submap->points.begin(), submap->points.end(),
            [&](const submap::SubmapPoint& a, const submap::SubmapPoint& b) { return key(a) < key(b); });
}

}  // namespace mapweld::test
