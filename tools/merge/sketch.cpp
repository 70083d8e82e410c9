// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/sketch.hpp"

#include <bit>
#include <cmath>
#include <cstddef>

#include "core/base/voxel_key.hpp"
#include "tools/merge/cosine_kernel.hpp"

namespace mapweld::merge {
namespace {

constexpr int kDim = place::kDescriptorDim;
constexpr int kBits = 256;
constexpr float kFixedPoint = 65536;  // of a component of a descriptor of unit length

using Vector = std::array<std::int32_t, kDim>;

Vector UnitVector(const DescriptorSet& drive, int keyframe) {
  Vector out;
  const float scale = kFixedPoint * drive.inverse_norm[static_cast<std::size_t>(keyframe)];
  const std::int8_t* q = drive.row(keyframe);
  for (std::size_t d = 0; d < out.size(); ++d) {
    out[d] = static_cast<std::int32_t>(std::lrint(static_cast<float>(q[d]) * scale));
  }
  return out;
}

// 256 sums of all dimensions with signs: random ones, folded four times, then a Walsh-Hadamard transform.
Sketch Signs(const Vector& v) {
  static const Vector random = [] {
    Vector out;
    for (std::size_t d = 0; d < out.size(); ++d) out[d] = (HashKey(d) & 1U) != 0 ? 1 : -1;
    return out;
  }();
  std::array<std::int32_t, kBits> t{};
  for (std::size_t d = 0; d < v.size(); ++d) t[d % kBits] += random[d] * v[d];
  for (std::size_t half = 1; half < kBits; half *= 2) {
    for (std::size_t block = 0; block < kBits; block += 2 * half) {
      for (std::size_t k = block; k < block + half; ++k) {
        const std::int32_t sum = t[k] + t[k + half];
        t[k + half] = t[k] - t[k + half];
        t[k] = sum;
      }
    }
  }
  Sketch out{};
  for (std::size_t k = 0; k < kBits; ++k) out[k / 64] |= static_cast<std::uint64_t>(t[k] > 0 ? 1 : 0) << (k % 64);
  return out;
}

}  // namespace

std::vector<Sketch> MakeSketches(const DescriptorSet& drive) {
  std::array<std::int64_t, kDim> sum{};
  int described = 0;
  for (int i = 0; i < drive.count; ++i) {
    if (drive.inverse_norm[static_cast<std::size_t>(i)] == 0) continue;
    const Vector v = UnitVector(drive, i);
    for (std::size_t d = 0; d < v.size(); ++d) sum[d] += v[d];
    ++described;
  }
  std::vector<Sketch> out(static_cast<std::size_t>(drive.count));
  for (int i = 0; i < drive.count; ++i) {
    if (drive.inverse_norm[static_cast<std::size_t>(i)] == 0) continue;
    Vector v = UnitVector(drive, i);
    for (std::size_t d = 0; d < v.size(); ++d) v[d] -= static_cast<std::int32_t>(sum[d] / described);
    out[static_cast<std::size_t>(i)] = Signs(v);
  }
  return out;
}

Cosines CompareSketches(const std::vector<Sketch>& a, int row_step, const std::vector<Sketch>& b) {
  Cosines out;
  out.cols = static_cast<int>(b.size());
  for (std::size_t i = 0; i < a.size(); i += static_cast<std::size_t>(row_step)) ++out.rows;
  out.c.resize(static_cast<std::size_t>(out.rows) * b.size());
  std::int16_t* to = out.c.data();
  constexpr int kPerBit = kCosineUnit / (kBits / 2);
  for (std::size_t i = 0; i < a.size(); i += static_cast<std::size_t>(row_step)) {
    const Sketch x = a[i];
    for (const Sketch& y : b) {
      const int bits = std::popcount(x[0] ^ y[0]) + std::popcount(x[1] ^ y[1]) + std::popcount(x[2] ^ y[2]) +
                       std::popcount(x[3] ^ y[3]);
      *to++ = static_cast<std::int16_t>(kCosineUnit - kPerBit * bits);
    }
  }
  return out;
}

}  // namespace mapweld::merge
