// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/voxel_mean.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mapweld::merge {
namespace {
constexpr std::uint64_t kEmpty = std::numeric_limits<std::uint64_t>::max();
constexpr float kLimit = 1e6F;             // voxels from the origin
constexpr std::int64_t kOffset = 1 << 20;  // makes indices positive, 21 bits each

bool KeyOf(const Eigen::Vector3f& p, float inverse_voxel, std::uint64_t* key) {
  const Eigen::Array3f cell = (p.array() * inverse_voxel).floor();
  if (!(cell.abs() < kLimit).all()) return false;  // also refuses NaN
  const auto index = [&](int axis) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[axis]) + kOffset);
  };
  *key = (index(2) << 42U) | (index(1) << 21U) | index(0);
  return true;
}
}  // namespace

VoxelMean::VoxelMean(double voxel_m) : inverse_voxel_(static_cast<float>(1 / voxel_m)) {
  cells_.resize(1U << 14U, Cell{kEmpty, 0, 0, 0, 0});
}

std::size_t VoxelMean::Slot(std::uint64_t key) const {
  const std::size_t mask = cells_.size() - 1;
  std::size_t slot = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ULL) >> 20U) & mask;
  while (cells_[slot].key != kEmpty && cells_[slot].key != key) slot = (slot + 1) & mask;
  return slot;
}

void VoxelMean::Grow() {
  std::vector<Cell> old(cells_.size() * 2, Cell{kEmpty, 0, 0, 0, 0});
  old.swap(cells_);
  for (const Cell& cell : old) {
    if (cell.key != kEmpty) cells_[Slot(cell.key)] = cell;
  }
}

void VoxelMean::Add(const Eigen::Vector3f& p, float weight) {
  std::uint64_t key = 0;
  if (!KeyOf(p, inverse_voxel_, &key)) return;
  if (2 * used_ > cells_.size()) Grow();
  Cell& cell = cells_[Slot(key)];
  if (cell.key == kEmpty) {
    cell = Cell{key, 0, 0, 0, 0};
    ++used_;
  }
  cell.x += weight * p.x();
  cell.y += weight * p.y();
  cell.z += weight * p.z();
  cell.weight += weight;
}

void VoxelMean::Take(std::vector<WeightedPoint>* out) {
  std::vector<Cell> full;
  full.reserve(used_);
  for (Cell& cell : cells_) {
    if (cell.key == kEmpty) continue;
    full.push_back(cell);
    cell.key = kEmpty;
  }
  used_ = 0;
  std::sort(full.begin(), full.end(), [](const Cell& a, const Cell& b) { return a.key < b.key; });
  out->clear();
  out->reserve(full.size());
  for (const Cell& c : full) out->push_back({Eigen::Vector3f(c.x, c.y, c.z) / c.weight, c.weight});
}

}  // namespace mapweld::merge
