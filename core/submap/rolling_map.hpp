// SPDX-License-Identifier: Apache-2.0
// Everything the vehicle saw on the last stretch of its path, as 0.5 m voxels in the odom frame. Submaps are cut from
// it.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/status.hpp"
#include "core/base/voxel_key.hpp"
#include "core/config/capacity.hpp"
#include "core/geom/pose3.hpp"
#include "core/submap/range_image.hpp"
#include "core/submap/submap.hpp"
#include "core/submap/submap_grid.hpp"

namespace mapweld::submap {

struct RollingMapConfig {
  float voxel_m = 0.5F;
  float radius_m = 50.0F;  // of a submap
  double reach_m = 130.0;  // a voxel belongs to a keyframe if it was last seen within this much path of it
  // Visibility voting: what stood somewhere for a while only. A voxel is left out of submaps when this many looks went
  // through it and they are this share of the looks that told anything. A share above 1 keeps everything.
  std::uint32_t min_through = 1;
  double max_through_share = 0.1;
};
static_assert(RollingMapConfig{}.radius_m / RollingMapConfig{}.voxel_m < static_cast<float>(kHalfExtent),
              "a submap fits the grid of its encoding");

// A set-associative hash table: kCap.submap_map_voxels slots of 28 bytes (7.3 MB), 8 to a bucket whose keys are one
// cache line. When a bucket is full the voxel that was seen longest ago (in metres of path) makes room. No work per
// scan depends on what the map holds.
//
// A voxel holds the mean and the number of its returns. No normal: one voxel seldom has enough returns for a good one,
// and whoever gets the submap computes it from the neighbouring means, at no bytes on the wire.
class RollingMap {
 public:
  explicit RollingMap(const RollingMapConfig& config = {}) : config_(config) {}

  // Adds one point in the odom frame, seen after path_m of travel. Points beyond +-500 km of the origin are refused.
  Status Insert(const Eigen::Vector3f& p_odom, double path_m);

  // Looks, in the newest scan, at every kVoteSlices-th part of the map in turn: which voxels are still there, through
  // which did the light pass? Call once a scan. Cost: one pass over that part, at most 60 flops a voxel.
  void Vote(const RangeImage& image, const Eigen::Vector3f& centre_odom, double path_m);

  // Cuts the submap of the keyframe at odom_T_body. One pass over the table and three over the points found, which come
  // out along the Z-order curve of their cells. When more than kCap.submap_points voxels lie within the radius the ones
  // beyond the capacity are left out: kFull.
  Status Extract(const geom::Pose3& odom_T_body, double path_m, Submap* submap);
  // The same in kCutSteps calls of CutStep after BeginCut, with other calls to Insert and Vote in between. The last one
  // gives the status.
  static constexpr std::size_t kCutSteps = 9;
  void BeginCut(const geom::Pose3& odom_T_body, double path_m, Submap* submap);
  Status CutStep(Submap* submap);

  [[nodiscard]] std::uint64_t evicted() const { return evicted_; }

 private:
  static constexpr std::size_t kWays = 8;
  static constexpr std::size_t kBuckets = kCap.submap_map_voxels / kWays;
  static constexpr std::size_t kVoteSlices = 4;
  struct alignas(64) Bucket {
    std::array<std::uint64_t, kWays> key{};  // packed cell + 1; 0 = free
  };
  struct Voxel {
    std::array<std::int32_t, 3> sum{};  // of the offsets inside the cell, 1/1024 of its edge
    std::uint32_t seen_dm = 0;          // path at the last sight, decimetres
    std::uint16_t count = 0;            // saturating
    std::uint8_t seen = 0;              // looks that found it ...
    std::uint8_t through = 0;           // ... and that passed through it; both are halved when one is full
  };
  static_assert(sizeof(Voxel) == 20);

  // A point of the submap, to be sorted.
  struct Found {
    std::uint32_t cell = 0;   // CellKey in the submap's frame
    std::uint32_t point = 0;  // index into the submap's points
  };
  using FoundPoints = FixedVector<Found, kCap.submap_points>;

  // The cut that is under way.
  struct Cut {
    geom::Vec3d centre_odom = geom::Vec3d::Zero();
    Eigen::Matrix3d level_R_odom = Eigen::Matrix3d::Identity();
    geom::Vec3d level_t_odom = geom::Vec3d::Zero();
    std::uint32_t seen_from_dm = 0;
    std::uint32_t seen_to_dm = 0;
    std::size_t step = 0;
    Status status = Status::kOk;
  };

  [[nodiscard]] std::uint64_t KeyOf(std::size_t slot) const { return keys_[slot / kWays].key[slot % kWays]; }
  std::size_t MakeRoom(std::uint64_t key);
  [[nodiscard]] geom::Vec3d MeanOf(const Cell& cell, const Voxel& voxel) const;
  [[nodiscard]] bool Moved(const Voxel& voxel) const;
  void Collect(std::size_t from, std::size_t to, Submap* submap);
  void Sort(Submap* submap);

  RollingMapConfig config_;
  std::uint64_t evicted_ = 0;
  std::size_t vote_slice_ = 0;
  Cut cut_;
  FoundPoints found_;
  FoundPoints sorted_;
  std::array<Bucket, kBuckets> keys_{};
  std::array<Voxel, kCap.submap_map_voxels> voxels_{};
};

}  // namespace mapweld::submap
