// SPDX-License-Identifier: Apache-2.0
// The odometry's local map: 1 m voxels, each a running Gaussian of the points that fell into it and, once it is flat
// enough, the plane through them.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/status.hpp"
#include "core/base/voxel_key.hpp"
#include "core/config/capacity.hpp"
#include "core/geom/so3.hpp"

namespace mapweld::lio {

struct VoxelMapConfig {
  float voxel_m = 1.0F;
  std::uint32_t min_points = 8;       // before a plane is fitted
  std::uint32_t mature_points = 400;  // after which a voxel no longer changes: the map must not follow the drift
  float max_thickness_m = 0.12F;      // rms distance of the points from their plane
  float min_width_m = 0.12F;          // rms extent along the narrower direction within the plane: not a mere line
};

struct Plane {
  Eigen::Vector3f mean;     // m, odom frame
  Eigen::Vector3f normal;   // unit
  float variance = 0;       // of the points across the plane, m^2
  float tilt_variance = 0;  // of the normal, rad^2, at most, if the points' errors were independent
};

// A set-associative hash table of kCap.lio_voxels slots, 8 to a bucket; when a bucket is full the voxel touched in the
// oldest scan makes room. No work per scan depends on the map's size. What every look-up needs (keys, counts, ages)
// lies apart from the sums, so that a bucket's keys are one cache line and a voxel that is complete costs no other.
class VoxelMap {
 public:
  explicit VoxelMap(const VoxelMapConfig& config = {}) : config_(config) {}

  // Starts a scan: the age of voxels counts in scans.
  void BeginScan() { ++scan_; }
  // Forgets everything; the age of scans goes on. Cost: one pass over the keys.
  void Clear() { keys_.fill({}); }
  // Adds one point in the odom frame. kOutOfRange beyond the limits of the grid.
  Status Insert(const Eigen::Vector3f& p_odom);
  // The plane nearest to the point among its own voxel and the three that share its nearer faces; false when none is
  // flat. Four look-ups.
  bool FindPlane(const Eigen::Vector3f& p_odom, Plane* plane);

  [[nodiscard]] std::uint64_t evicted() const { return evicted_; }
  [[nodiscard]] const VoxelMapConfig& config() const { return config_; }

 private:
  static constexpr std::size_t kWays = 8;
  static constexpr std::size_t kBuckets = kCap.lio_voxels / kWays;
  static constexpr std::size_t kNone = kCap.lio_voxels;
  struct alignas(64) Bucket {
    std::array<std::uint64_t, kWays> key{};  // packed cell + 1; 0 = free
  };
  struct Voxel {
    std::array<float, 3> mean{};  // of the fitted plane, odom frame
    std::array<float, 3> normal{};
    float variance = 0;
    float tilt_variance = 0;
    std::uint32_t fitted_count = 0;  // points when the plane was last fitted; 0 = never
    bool flat = false;
    std::array<float, 3> sum{};     // of offsets from the cell's centre, m
    std::array<float, 6> sum_sq{};  // xx xy xz yy yz zz
  };

  [[nodiscard]] std::size_t Find(std::uint64_t key) const;  // kNone: not there
  std::size_t MakeRoom(std::uint64_t key);
  void FitPlane(const Cell& cell, std::uint32_t count, Voxel* voxel) const;

  VoxelMapConfig config_;
  std::uint32_t scan_ = 0;
  std::uint64_t evicted_ = 0;
  std::array<Bucket, kBuckets> keys_{};
  std::array<std::uint32_t, kCap.lio_voxels> count_{};
  std::array<std::uint32_t, kCap.lio_voxels> touched_scan_{};
  std::array<Voxel, kCap.lio_voxels> voxels_{};
};

}  // namespace mapweld::lio
