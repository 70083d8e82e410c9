// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/difference.hpp"

#include <algorithm>
#include <cmath>

namespace mapweld::merge {
namespace {

constexpr int kBlock = 16;  // descriptors; 16 KiB of each drive

std::int32_t Dot(const place::PlaceDescriptor& a, const place::PlaceDescriptor& b) {
  std::int32_t sum = 0;
  for (std::size_t i = 0; i < a.q.size(); ++i)
    sum += static_cast<std::int32_t>(a.q[i]) * static_cast<std::int32_t>(b.q[i]);
  return sum;
}

std::vector<float> InverseNorms(const Drive& drive) {
  std::vector<float> out;
  for (const Keyframe& keyframe : drive.keyframes) {
    const place::PlaceDescriptor& descriptor = keyframe.place.descriptor;
    const std::int32_t squared = Dot(descriptor, descriptor);
    const bool valid = squared > 0 && descriptor.scale > 0;
    out.push_back(valid ? 1 / std::sqrt(static_cast<float>(squared)) : 0);
  }
  return out;
}

}  // namespace

Distances ComputeDistances(const Drive& a, const Drive& b) {
  Distances out;
  out.rows = static_cast<int>(a.keyframes.size());
  out.cols = static_cast<int>(b.keyframes.size());
  out.d.resize(a.keyframes.size() * b.keyframes.size());
  const std::vector<float> norm_a = InverseNorms(a);
  const std::vector<float> norm_b = InverseNorms(b);
  for (int row_block = 0; row_block < out.rows; row_block += kBlock) {
    for (int col_block = 0; col_block < out.cols; col_block += kBlock) {
      for (int row = row_block; row < std::min(out.rows, row_block + kBlock); ++row) {
        for (int col = col_block; col < std::min(out.cols, col_block + kBlock); ++col) {
          const auto i = static_cast<std::size_t>(row);
          const auto j = static_cast<std::size_t>(col);
          const auto dot = static_cast<float>(Dot(a.keyframes[i].place.descriptor, b.keyframes[j].place.descriptor));
          out.d[i * b.keyframes.size() + j] = 1 - dot * norm_a[i] * norm_b[j];
        }
      }
    }
  }
  return out;
}

DifferenceMatrix ToImage(const Distances& distances, int drive_a, int drive_b) {
  DifferenceMatrix out;
  out.drive_a = drive_a;
  out.drive_b = drive_b;
  out.rows = distances.rows;
  out.cols = distances.cols;
  out.distance.reserve(distances.d.size());
  for (const float d : distances.d) {
    out.distance.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(d, 0.0F, 1.0F))));
  }
  return out;
}

}  // namespace mapweld::merge
