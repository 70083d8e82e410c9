// SPDX-License-Identifier: Apache-2.0
// Means of points per cubic voxel.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace mapweld::merge {

struct WeightedPoint {
  Eigen::Vector3f p;
  float weight = 1;
};

// Open-addressing table that grows; the order of the output depends only on the occupied voxels.
// Points further than 1e6 voxels from the origin are left out.
class VoxelMean {
 public:
  explicit VoxelMean(double voxel_m);
  void Add(const Eigen::Vector3f& p, float weight);
  // One point per occupied voxel, ordered by z, y, x of the voxel. Empties the table, keeps its memory.
  void Take(std::vector<WeightedPoint>* out);

 private:
  struct Cell {
    std::uint64_t key;
    float x, y, z, weight;
  };
  void Grow();
  std::size_t Slot(std::uint64_t key) const;

  float inverse_voxel_;
  std::vector<Cell> cells_;
  std::size_t used_ = 0;
};

}  // namespace mapweld::merge
