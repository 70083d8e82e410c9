// SPDX-License-Identifier: Apache-2.0
#include "core/submap/rolling_map.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/voxel_key.hpp"
#include "core/submap/submap_grid.hpp"

namespace mapweld::submap {
namespace {

constexpr float kOffsetSteps = 1024.0F;
constexpr std::uint32_t kMaxCount = 65535;

}  // namespace

Status RollingMap::Insert(const Eigen::Vector3f& p_odom, double path_m) {
  const Eigen::Vector3f scaled = p_odom / config_.voxel_m;
  if (!scaled.allFinite() || scaled.cwiseAbs().maxCoeff() >= static_cast<float>(kCellLimit)) return Status::kOutOfRange;
  const Cell cell{CellIndex(scaled.x()), CellIndex(scaled.y()), CellIndex(scaled.z())};
  const std::uint64_t key = PackCell(cell);
  Voxel* const bucket = &voxels_[(HashKey(key) % kBuckets) * kWays];

  Voxel* slot = nullptr;
  Voxel* oldest = bucket;
  for (std::size_t i = 0; i < kWays; ++i) {
    if (bucket[i].key == key) {
      slot = &bucket[i];
      break;
    }
    if (bucket[i].key == 0) {
      if (oldest->key != 0) oldest = &bucket[i];
    } else if (oldest->key != 0 && bucket[i].seen_dm < oldest->seen_dm) {
      oldest = &bucket[i];
    }
  }
  if (slot == nullptr) {
    if (oldest->key != 0) ++evicted_;
    slot = oldest;
    *slot = Voxel{};
    slot->key = key;
  }
  slot->seen_dm = static_cast<std::uint32_t>(path_m * 10.0);
  if (slot->count >= kMaxCount) return Status::kOk;
  ++slot->count;
  slot->sum[0] += static_cast<std::int32_t>((scaled.x() - static_cast<float>(cell.x)) * kOffsetSteps);
  slot->sum[1] += static_cast<std::int32_t>((scaled.y() - static_cast<float>(cell.y)) * kOffsetSteps);
  slot->sum[2] += static_cast<std::int32_t>((scaled.z() - static_cast<float>(cell.z)) * kOffsetSteps);
  return Status::kOk;
}

// The mean of a voxel's returns in the submap's frame.
SubmapPoint RollingMap::PointOf(const Voxel& voxel, const Eigen::Matrix3d& level_R_odom,
                                const geom::Vec3d& level_t_odom) const {
  const Cell cell = UnpackCell(voxel.key);
  const auto to_m = static_cast<double>(config_.voxel_m);
  const double per_count = 1.0 / (static_cast<double>(kOffsetSteps) * voxel.count);
  const geom::Vec3d mean_odom((cell.x + voxel.sum[0] * per_count) * to_m, (cell.y + voxel.sum[1] * per_count) * to_m,
                              (cell.z + voxel.sum[2] * per_count) * to_m);
  const Eigen::Vector3f p = (level_R_odom * mean_odom + level_t_odom).cast<float>();
  return {p.x(), p.y(), p.z(), static_cast<std::uint16_t>(voxel.count), 0};
}

// Radix sort by cell, 8 bits at a time; the voxels of one cell by their own keys, so that the order does not depend on
// where the hash put them.
void RollingMap::SortFound() {
  for (unsigned shift = 0; shift < 24; shift += 8) {
    std::array<std::uint32_t, 257> begin{};
    for (const Found& found : found_) ++begin[((found.cell >> shift) & 0xFFU) + 1];
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    sorted_.resize(found_.size());
    for (const Found& found : found_) sorted_[begin[(found.cell >> shift) & 0xFFU]++] = found;
    std::copy(sorted_.begin(), sorted_.end(), found_.begin());
  }
  for (std::size_t i = 1; i < found_.size(); ++i) {
    for (std::size_t k = i; k > 0 && found_[k - 1].cell == found_[k].cell &&
                            voxels_[found_[k].voxel].key < voxels_[found_[k - 1].voxel].key;
         --k) {
      std::swap(found_[k - 1], found_[k]);
    }
  }
}

Status RollingMap::Extract(const geom::Pose3& odom_T_body, double path_m, Submap* submap) {
  const geom::Pose3 level_T_odom = geom::Level(odom_T_body).Inverse();
  const Eigen::Matrix3d level_R_odom = level_T_odom.q.toRotationMatrix();
  const auto seen_from = static_cast<std::uint32_t>(std::max(0.0, (path_m - config_.reach_m) * 10.0));
  const auto seen_to = static_cast<std::uint32_t>((path_m + config_.reach_m) * 10.0);

  submap->voxel_m = config_.voxel_m;
  submap->radius_m = config_.radius_m;
  submap->points.clear();
  found_.clear();
  const geom::Vec3d centre = odom_T_body.t / static_cast<double>(config_.voxel_m);
  const auto reach = static_cast<double>(config_.radius_m / config_.voxel_m) + 2;
  Status status = Status::kOk;
  for (std::uint32_t i = 0; i < voxels_.size(); ++i) {
    const Voxel& voxel = voxels_[i];
    if (voxel.key == 0 || voxel.seen_dm < seen_from || voxel.seen_dm > seen_to) continue;
    const Cell cell = UnpackCell(voxel.key);
    if (std::abs(cell.x - centre.x()) > reach || std::abs(cell.y - centre.y()) > reach) continue;
    const SubmapPoint point = PointOf(voxel, level_R_odom, level_T_odom.t);
    if (point.x * point.x + point.y * point.y + point.z * point.z > config_.radius_m * config_.radius_m) continue;
    Found found{0, i};
    if (!CellKey(point, config_.voxel_m, &found.cell)) continue;
    if (found_.TryPush(found) != Status::kOk) {
      status = Status::kFull;
      break;
    }
  }
  SortFound();
  for (const Found& found : found_) {
    (void)submap->points.TryPush(PointOf(voxels_[found.voxel], level_R_odom, level_T_odom.t));  // same capacity
  }
  return status;
}

}  // namespace mapweld::submap
