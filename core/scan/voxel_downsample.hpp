// SPDX-License-Identifier: Apache-2.0
// Thins a scan to one point per voxel.
#pragma once

#include <array>
#include <cstdint>

#include "core/scan/deskew.hpp"

namespace mapweld::scan {

using FeaturePoints = FixedVector<BodyPoint, kCap.scan_features>;

// Keeps the first point of each voxel, in scan order. The hash table is cleared by a generation number, not by writing.
// Cost: one table look-up per point, a few probes at worst (kMaxProbes). When *out is full the rest is dropped.
class VoxelDownsample {
 public:
  void Run(const BodyPoints& in, float voxel_m, FeaturePoints* out);

 private:
  static constexpr std::size_t kSlots = 4 * kCap.scan_features;
  static constexpr std::size_t kMaxProbes = 16;
  struct Slot {
    std::uint64_t key = 0;
    std::uint64_t generation = 0;
  };
  std::array<Slot, kSlots> slots_{};
  std::uint64_t generation_ = 0;
};

}  // namespace mapweld::scan
