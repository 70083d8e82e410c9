// SPDX-License-Identifier: Apache-2.0
#include "core/submap/rolling_map.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/voxel_key.hpp"

namespace mapweld::submap {
namespace {

constexpr float kOffsetSteps = 1024.0F;
constexpr std::uint32_t kMaxCount = 65535;

// Order in which points are stored: z, then y, then x of the 0.5 m cell in the level frame.
struct ByCell {
  float inverse_voxel;
  [[nodiscard]] std::uint64_t Key(const SubmapPoint& p) const {
    return PackCell({CellIndex(p.x * inverse_voxel), CellIndex(p.y * inverse_voxel), CellIndex(p.z * inverse_voxel)});
  }
  bool operator()(const SubmapPoint& a, const SubmapPoint& b) const {
    const std::uint64_t ka = Key(a);
    const std::uint64_t kb = Key(b);
    if (ka != kb) return ka < kb;
    if (a.z != b.z) return a.z < b.z;
    if (a.y != b.y) return a.y < b.y;
    return a.x < b.x;
  }
};

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

Status RollingMap::Extract(const geom::Pose3& odom_T_body, double path_m, Submap* submap) const {
  const geom::Pose3 level_T_odom = geom::Level(odom_T_body).Inverse();
  const Eigen::Matrix3d level_R_odom = level_T_odom.q.toRotationMatrix();
  const double radius_squared = static_cast<double>(config_.radius_m) * static_cast<double>(config_.radius_m);
  const double seen_from = (path_m - config_.reach_m) * 10.0;
  const double seen_to = (path_m + config_.reach_m) * 10.0;

  submap->voxel_m = config_.voxel_m;
  submap->radius_m = config_.radius_m;
  submap->points.clear();
  Status status = Status::kOk;
  for (const Voxel& voxel : voxels_) {
    if (voxel.key == 0) continue;
    const double seen = static_cast<double>(voxel.seen_dm);
    if (seen < seen_from || seen > seen_to) continue;
    const Cell cell = UnpackCell(voxel.key);
    const double to_m = static_cast<double>(config_.voxel_m);
    const double per_count = 1.0 / (static_cast<double>(kOffsetSteps) * voxel.count);
    const Eigen::Vector3d mean_odom((cell.x + voxel.sum[0] * per_count) * to_m,
                                    (cell.y + voxel.sum[1] * per_count) * to_m,
                                    (cell.z + voxel.sum[2] * per_count) * to_m);
    if ((mean_odom - odom_T_body.t).squaredNorm() > radius_squared) continue;
    const Eigen::Vector3f p = (level_R_odom * mean_odom + level_T_odom.t).cast<float>();
    const SubmapPoint point{p.x(), p.y(), p.z(), static_cast<std::uint16_t>(voxel.count), 0};
    if (submap->points.TryPush(point) != Status::kOk) {
      status = Status::kFull;
      break;
    }
  }
  std::sort(submap->points.begin(), submap->points.end(), ByCell{1.0F / config_.voxel_m});
  return status;
}

}  // namespace mapweld::submap
