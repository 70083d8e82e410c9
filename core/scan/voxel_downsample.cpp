// SPDX-License-Identifier: Apache-2.0
#include "core/scan/voxel_downsample.hpp"

#include "core/base/voxel_key.hpp"

namespace mapweld::scan {

void VoxelDownsample::Run(const BodyPoints& in, float voxel_m, FeaturePoints* out) {
  ++generation_;
  out->clear();
  const float inverse = 1.0F / voxel_m;
  for (const BodyPoint& point : in) {
    const Cell cell{CellIndex(point.p.x() * inverse), CellIndex(point.p.y() * inverse),
                    CellIndex(point.p.z() * inverse)};
    const std::uint64_t key = PackCell(cell);
    std::size_t at = HashKey(key) % kSlots;
    for (std::size_t probe = 0; probe < kMaxProbes; ++probe, at = (at + 1) % kSlots) {
      Slot& slot = slots_[at];
      if (slot.generation == generation_ && slot.key != key) continue;
      if (slot.generation != generation_) {
        if (out->TryPush(point) != Status::kOk) return;
        slot = {key, generation_};
      }
      break;
    }
  }
}

}  // namespace mapweld::scan
