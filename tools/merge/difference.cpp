// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/difference.hpp"

#include <algorithm>

#include "tools/merge/cosine_kernel.hpp"

namespace mapweld::merge {

Cosines ComputeCosines(const DescriptorSet& a, const DescriptorSet& b) {
  return GrowCosines({}, a, b);
}

Cosines ComputeCosines(const Drive& a, const Drive& b) {
  return ComputeCosines(CollectDescriptors(a), CollectDescriptors(b));
}

Cosines GrowCosines(const Cosines& known, const DescriptorSet& a, const DescriptorSet& b) {
  Cosines out;
  out.rows = a.count;
  out.cols = b.count;
  const auto stride = static_cast<std::size_t>(b.count);
  out.c.resize(static_cast<std::size_t>(a.count) * stride);
  const int rows = std::min(known.rows, a.count);
  const int cols = std::min(known.cols, b.count);
  for (int row = 0; row < rows; ++row) {
    std::copy_n(known.c.begin() + static_cast<std::ptrdiff_t>(row) * known.cols, cols,
                out.c.begin() + static_cast<std::ptrdiff_t>(row) * out.cols);
  }
  const CosineFunction compute = FastestCosineKernel().compute;
  if (cols < out.cols && rows > 0) compute(a, {0, rows}, b, {cols, out.cols}, out.c.data() + cols, stride);
  if (rows < out.rows && out.cols > 0) {
    compute(a, {rows, out.rows}, b, {0, out.cols}, out.c.data() + static_cast<std::size_t>(rows) * stride, stride);
  }
  return out;
}

DifferenceMatrix ToImage(const Cosines& cosines, int drive_a, int drive_b) {
  DifferenceMatrix out;
  out.drive_a = drive_a;
  out.drive_b = drive_b;
  out.rows = cosines.rows;
  out.cols = cosines.cols;
  out.distance.reserve(cosines.c.size());
  for (const std::int16_t c : cosines.c) {
    const int distance = kCosineUnit - std::clamp<int>(c, 0, kCosineUnit);
    out.distance.push_back(static_cast<std::uint8_t>((255 * distance + kCosineUnit / 2) / kCosineUnit));
  }
  return out;
}

}  // namespace mapweld::merge
