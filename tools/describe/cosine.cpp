// SPDX-License-Identifier: Apache-2.0
#include "tools/describe/cosine.hpp"

#include <Eigen/Core>
#include <cmath>

namespace mapweld::describe {

PlaceMethod::Features UnitFeatures(const place::PlaceDescriptor& descriptor, int size) {
  PlaceMethod::Features unit(descriptor.q.begin(), descriptor.q.begin() + size);
  std::int64_t squared = 0;
  for (int i = 0; i < size; ++i)
    squared += descriptor.q[static_cast<std::size_t>(i)] * descriptor.q[static_cast<std::size_t>(i)];
  if (squared == 0) return unit;
  const auto factor = static_cast<float>(1 / std::sqrt(static_cast<double>(squared)));
  for (float& v : unit) v *= factor;
  return unit;
}

float CosineDistance(const PlaceMethod::Features& a, const PlaceMethod::Features& b) {
  const auto size = static_cast<Eigen::Index>(a.size());
  return 1.0F -
         Eigen::Map<const Eigen::VectorXf>(a.data(), size).dot(Eigen::Map<const Eigen::VectorXf>(b.data(), size));
}

}  // namespace mapweld::describe
