// SPDX-License-Identifier: Apache-2.0
// The distance between every keyframe of one drive and every keyframe of another (paper, section V-A).
#pragma once

#include <vector>

#include "tools/merge/drive.hpp"
#include "tools/merge/merge_result.hpp"

namespace mapweld::merge {

struct Distances {
  int rows = 0;          // keyframes of a
  int cols = 0;          // keyframes of b
  std::vector<float> d;  // row-major, cosine distance 0..2
  [[nodiscard]] float at(int row, int col) const {
    return d[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)];
  }
};

// Keyframes without a description (scale 0) are at distance 1 from all others. Cost: 1024 integer multiply-adds per
// entry, in blocks that stay in the first-level cache.
Distances ComputeDistances(const Drive& a, const Drive& b);

// For the report: 0 = same, 255 = distance 1 or more.
DifferenceMatrix ToImage(const Distances& distances, int drive_a, int drive_b);

}  // namespace mapweld::merge
