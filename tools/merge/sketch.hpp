// SPDX-License-Identifier: Apache-2.0
// 256 bits of every descriptor: signs of random projections (Charikar, STOC 2002), after taking off what all keyframes
// of the drive have in common. Thirty times cheaper to compare than the descriptors; they decide which pairs of drives
// are worth a full comparison.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/merge/difference.hpp"

namespace mapweld::merge {

using Sketch = std::array<std::uint64_t, 4>;

// One per keyframe; zeros for those without a description. Depends on the drive alone. About 3 us per keyframe.
std::vector<Sketch> MakeSketches(const DescriptorSet& drive);

// Of every row_step-th sketch of a and every one of b: 1 less 1/128 per bit that differs, in units of 1 / kCosineUnit.
// About 1 ns per entry.
Cosines CompareSketches(const std::vector<Sketch>& a, int row_step, const std::vector<Sketch>& b);

}  // namespace mapweld::merge
