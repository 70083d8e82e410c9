// SPDX-License-Identifier: Apache-2.0
// How alike every keyframe of one drive is to every keyframe of another (paper, section V-A: the difference matrix).
#pragma once

#include <cstdint>
#include <vector>

#include "tools/merge/descriptor_set.hpp"
#include "tools/merge/merge_result.hpp"

namespace mapweld::merge {

// Row-major cosines in units of 1 / kCosineUnit (cosine_kernel.hpp).
struct Cosines {
  int rows = 0;  // keyframes of a
  int cols = 0;  // keyframes of b
  std::vector<std::int16_t> c;
  [[nodiscard]] std::int16_t at(int row, int col) const {
    return c[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col)];
  }
};

// Keyframes without a description have cosine 0 with all others. 1024 multiply-adds per entry: about 10 ns with AVX2,
// 5 with VNNI.
Cosines ComputeCosines(const DescriptorSet& a, const DescriptorSet& b);
Cosines ComputeCosines(const Drive& a, const Drive& b);

// The same when both drives may have grown since `known` was computed: only what is new is computed.
Cosines GrowCosines(const Cosines& known, const DescriptorSet& a, const DescriptorSet& b);

// For the report: 0 = same, 255 = cosine 0 or less.
DifferenceMatrix ToImage(const Cosines& cosines, int drive_a, int drive_b);

}  // namespace mapweld::merge
