// SPDX-License-Identifier: Apache-2.0
#include "tools/report/merged_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <unordered_map>

#include "tools/report/palette.hpp"

namespace mapweld::report {
namespace {

// 21 bits per axis, z slowest, so that keys sort by position.
constexpr std::int64_t kHalfRange = 1 << 20;

struct VoxelHash {
  std::size_t operator()(std::uint64_t key) const {
    key ^= key >> 33U;
    key *= 0xFF51AFD7ED558CCDULL;
    return key ^ (key >> 33U);
  }
};

struct Voxel {
  Eigen::Vector3f offset_sum =
      Eigen::Vector3f::Zero();  // from the voxel's corner: keeps floats exact far from the origin
  std::uint32_t count = 0;
  int drive = 0;
};

using VoxelTable = std::unordered_map<std::uint64_t, Voxel, VoxelHash>;

void AddPoint(const Eigen::Vector3d& p_merged, double voxel_m, int drive, VoxelTable* table) {
  const Eigen::Vector3d cell = (p_merged / voxel_m).array().floor();
  if (!(cell.cwiseAbs().maxCoeff() < static_cast<double>(kHalfRange - 1))) return;  // also drops what is no number
  std::uint64_t key = 0;
  for (const Eigen::Index axis : {2, 1, 0}) {
    key = (key << 21U) | static_cast<std::uint64_t>(static_cast<std::int64_t>(cell(axis)) + kHalfRange);
  }
  Voxel& voxel = (*table)[key];
  if (voxel.count == 0) voxel.drive = drive;
  voxel.offset_sum += (p_merged - cell * voxel_m).cast<float>();
  ++voxel.count;
}

MapPoint Mean(std::uint64_t key, const Voxel& voxel, double voxel_m) {
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
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
      const std::shared_ptr<const merge::SubmapCloud> cloud = submaps->Find({drive, static_cast<int>(k)});
      if (cloud == nullptr) continue;
      const geom::Pose3 merged_T_level = MergedTLevel(result.merged_T_body.at(d).at(k), keyframes[k].odom_T_body);
      for (const Eigen::Vector3f& p_level : cloud->points) {
        AddPoint(merged_T_level * p_level.cast<double>(), voxel_m, drive, &table);
      }
    }
  }
  std::vector<std::uint64_t> keys;
  keys.reserve(table.size());
  for (const auto& [key, voxel] : table) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  std::vector<MapPoint> points;
  points.reserve(keys.size());
  for (const std::uint64_t key : keys) points.push_back(Mean(key, table.find(key)->second, voxel_m));
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
