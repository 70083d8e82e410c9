// SPDX-License-Identifier: Apache-2.0
// Everything the vehicle saw on the last stretch of its path, as 0.5 m voxels in the odom frame. Submaps are cut from
// it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/config/capacity.hpp"
#include "core/geom/pose3.hpp"
#include "core/submap/submap.hpp"

namespace mapweld::submap {

struct RollingMapConfig {
  float voxel_m = 0.5F;
  float radius_m = 50.0F;  // of a submap; at most 127 voxels
  double reach_m = 130.0;  // a voxel belongs to a keyframe if it was last seen within this much path of it
};

// A set-associative hash table: kCap.submap_map_voxels slots of 32 bytes (8.4 MB), 8 to a bucket. When a bucket is full
// the voxel that was seen longest ago (in metres of path) makes room. No work per scan depends on the map's size.
class RollingMap {
 public:
  explicit RollingMap(const RollingMapConfig& config = {}) : config_(config) {}

  // Adds one point in the odom frame, seen after path_m of travel. Points beyond +-500 km of the origin are refused.
  Status Insert(const Eigen::Vector3f& p_odom, double path_m);

  // Cuts the submap of the keyframe at odom_T_body. One pass over the table and three over the points found, which come
  // out along the Z-order curve of their cells. When more than kCap.submap_points voxels lie within the radius the ones
  // beyond the capacity are left out: kFull.
  Status Extract(const geom::Pose3& odom_T_body, double path_m, Submap* submap);

  [[nodiscard]] std::uint64_t evicted() const { return evicted_; }

 private:
  static constexpr std::size_t kWays = 8;
  static constexpr std::size_t kBuckets = kCap.submap_map_voxels / kWays;
  struct Voxel {
    std::uint64_t key = 0;              // packed cell + 1; 0 = free
    std::array<std::int32_t, 3> sum{};  // of the offsets inside the cell, 1/1024 of its edge
    std::uint32_t count = 0;
    std::uint32_t seen_dm = 0;  // path at the last sight, decimetres
  };
  static_assert(sizeof(Voxel) == 32);

  // A voxel within the submap, to be sorted.
  struct Found {
    std::uint32_t cell = 0;   // CellKey in the submap's frame
    std::uint32_t voxel = 0;  // index into voxels_
  };
  using FoundVoxels = FixedVector<Found, kCap.submap_points>;

  [[nodiscard]] SubmapPoint PointOf(const Voxel& voxel, const Eigen::Matrix3d& level_R_odom,
                                    const geom::Vec3d& level_t_odom) const;
  void SortFound();

  RollingMapConfig config_;
  std::uint64_t evicted_ = 0;
  FoundVoxels found_;
  FoundVoxels sorted_;
  std::array<Voxel, kCap.submap_map_voxels> voxels_{};
};

}  // namespace mapweld::submap
