// SPDX-License-Identifier: Apache-2.0
// The descriptors of one drive, row by row, as the cosine kernels want them.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/merge/drive.hpp"

namespace mapweld::merge {

struct DescriptorSet {
  int count = 0;
  std::vector<std::int8_t> q;       // count x place::kDescriptorDim, -127..127
  std::vector<float> inverse_norm;  // 1 / |q|, 0 for a keyframe without a description
  [[nodiscard]] const std::int8_t* row(int i) const {
    return q.data() + static_cast<std::ptrdiff_t>(i) * place::kDescriptorDim;
  }
};

// -128, which the describer never writes, counts as -127: the fast kernels need a symmetric range. 1 KiB a keyframe.
DescriptorSet CollectDescriptors(const Drive& drive);

}  // namespace mapweld::merge
