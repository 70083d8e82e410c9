// SPDX-License-Identifier: Apache-2.0
#include "tools/report/merged_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "core/base/voxel_key.hpp"
#include "tools/report/palette.hpp"

namespace mapweld::report {
namespace {

// A submap reaches 50 m, so that every other keyframe shows all that there is to see.
constexpr double kSpacing_m = 9.9;

// 21 bits per axis, z slowest, so that keys sort by position.
constexpr std::int64_t kHalfRange = 1 << 20;

struct Voxel {
  std::uint64_t key = 0;
  Eigen::Vector3f offset_sum = Eigen::Vector3f::Zero();  // from the corner: keeps floats exact far from the origin
  std::uint32_t count = 0;                               // 0: free
  int drive = 0;
};

// Open addressing; doubles when three quarters are taken. The 64 voxels of a block of 4 x 4 x 4 lie together: the
// points of a submap come block by block, and a city's table is far larger than any cache.
class VoxelTable {
 public:
  VoxelTable() : voxels_(std::size_t{1} << 16U) {}

  Voxel& At(std::uint64_t key) {
    if (4 * used_ > 3 * voxels_.size()) Grow();
    Voxel& voxel = voxels_[Find(key)];
    if (voxel.count == 0) {
      voxel.key = key;
      ++used_;
    }
    return voxel;
  }
  // By rising key; the table is empty afterwards.
  std::vector<Voxel> Take() {
    std::erase_if(voxels_, [](const Voxel& voxel) { return voxel.count == 0; });
    std::sort(voxels_.begin(), voxels_.end(), [](const Voxel& x, const Voxel& y) { return x.key < y.key; });
    return std::move(voxels_);
  }

 private:
  // The low two bits of each axis say where a voxel lies in its block.
  static constexpr std::uint64_t kInBlock = 3U | (std::uint64_t{3} << 21U) | (std::uint64_t{3} << 42U);
  static std::uint64_t PlaceInBlock(std::uint64_t key) {
    return (key & 3U) | ((key >> 19U) & 12U) | ((key >> 38U) & 48U);
  }
  [[nodiscard]] std::size_t Find(std::uint64_t key) const {
    const std::size_t mask = voxels_.size() - 1;
    std::size_t slot = (HashKey(key & ~kInBlock) + PlaceInBlock(key)) & mask;
    while (voxels_[slot].count != 0 && voxels_[slot].key != key) slot = (slot + 1) & mask;
    return slot;
  }
  void Grow() {
    std::vector<Voxel> old(2 * voxels_.size());
    old.swap(voxels_);
    for (const Voxel& voxel : old) {
      if (voxel.count != 0) voxels_[Find(voxel.key)] = voxel;
    }
  }

  std::vector<Voxel> voxels_;
  std::size_t used_ = 0;
};

void AddPoint(const Eigen::Vector3d& p_merged, double voxel_m, int drive, VoxelTable* table) {
  const Eigen::Vector3d cell = (p_merged / voxel_m).array().floor();
  if (!(cell.cwiseAbs().maxCoeff() < static_cast<double>(kHalfRange - 1))) return;  // also drops what is no number
  std::uint64_t key = 0;
  for (const Eigen::Index axis : {2, 1, 0}) {
    key = (key << 21U) | static_cast<std::uint64_t>(static_cast<std::int64_t>(cell(axis)) + kHalfRange);
  }
  Voxel& voxel = table->At(key);
  if (voxel.count == 0) voxel.drive = drive;
  voxel.offset_sum += (p_merged - cell * voxel_m).cast<float>();
  ++voxel.count;
}

MapPoint Mean(const Voxel& voxel, double voxel_m) {
  std::uint64_t key = voxel.key;
  constexpr std::uint64_t kMask = (1U << 21U) - 1;
  Eigen::Vector3d corner;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    corner(axis) = static_cast<double>(static_cast<std::int64_t>(key & kMask) - kHalfRange) * voxel_m;
    key >>= 21U;
  }
  return {(corner + (voxel.offset_sum / static_cast<float>(voxel.count)).cast<double>()).cast<float>(), voxel.drive};
}

}  // namespace

geom::Pose3 MergedTLevel(const geom::Pose3& merged_T_body, const geom::Pose3& odom_T_body) {
  return merged_T_body * odom_T_body.Inverse() * geom::Level(odom_T_body);
}

std::vector<MapPoint> BuildGroupMap(const std::vector<merge::Drive>& drives, const merge::MergeResult& result,
                                    int group, merge::SubmapSource* submaps, double voxel_m) {
  if (!(voxel_m > 0)) throw std::runtime_error("the voxel size of the merged map must be positive");
  VoxelTable table;
  for (const int drive : result.groups.at(static_cast<std::size_t>(group))) {
    const auto d = static_cast<std::size_t>(drive);
    const std::vector<merge::Keyframe>& keyframes = drives.at(d).keyframes;
    double used_at_m = -kSpacing_m;
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
      const bool is_last = k + 1 == keyframes.size();
      if (!is_last && keyframes[k].path_m - used_at_m < kSpacing_m) continue;
      const std::shared_ptr<const merge::SubmapCloud> cloud = submaps->Find({drive, static_cast<int>(k)});
      if (cloud == nullptr) continue;
      used_at_m = keyframes[k].path_m;
      const geom::Pose3 merged_T_level = MergedTLevel(result.merged_T_body.at(d).at(k), keyframes[k].odom_T_body);
      for (const Eigen::Vector3f& p_level : cloud->points) {
        AddPoint(merged_T_level * p_level.cast<double>(), voxel_m, drive, &table);
      }
    }
  }
  std::vector<MapPoint> points;
  for (const Voxel& voxel : table.Take()) points.push_back(Mean(voxel, voxel_m));
  return points;
}

io::PointCloud ColoredByDrive(const std::vector<MapPoint>& points) {
  io::PointCloud cloud;
  cloud.points.reserve(points.size());
  cloud.colors.reserve(points.size());
  for (const MapPoint& point : points) {
    cloud.points.push_back(point.p_merged);
    cloud.colors.push_back(DriveColor(point.drive));
  }
  return cloud;
}

}  // namespace mapweld::report
