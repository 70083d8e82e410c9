// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/descriptor_set.hpp"

#include <algorithm>
#include <cmath>

namespace mapweld::merge {

DescriptorSet CollectDescriptors(const Drive& drive) {
  DescriptorSet out;
  out.count = static_cast<int>(drive.keyframes.size());
  out.q.reserve(drive.keyframes.size() * place::kDescriptorDim);
  for (const Keyframe& keyframe : drive.keyframes) {
    const place::PlaceDescriptor& descriptor = keyframe.place.descriptor;
    std::int32_t squared = 0;
    for (const std::int8_t raw : descriptor.q) {
      const std::int8_t value = std::max<std::int8_t>(raw, -127);
      out.q.push_back(value);
      squared += value * value;
    }
    const bool valid = squared > 0 && descriptor.scale > 0;
    out.inverse_norm.push_back(valid ? 1 / std::sqrt(static_cast<float>(squared)) : 0);
  }
  return out;
}

}  // namespace mapweld::merge
