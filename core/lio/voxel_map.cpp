// SPDX-License-Identifier: Apache-2.0
#include "core/lio/voxel_map.hpp"

#include <Eigen/Eigenvalues>

namespace mapweld::lio {
namespace {

Eigen::Vector3f CellCentre(const Cell& cell, float voxel_m) {
  return (Eigen::Vector3f(static_cast<float>(cell.x), static_cast<float>(cell.y), static_cast<float>(cell.z)).array() +
          0.5F) *
         voxel_m;
}

}  // namespace

std::size_t VoxelMap::Find(std::uint64_t key) const {
  const std::size_t bucket = HashKey(key) % kBuckets;
  for (std::size_t i = 0; i < kWays; ++i) {
    if (keys_[bucket].key[i] == key) return bucket * kWays + i;
  }
  return kNone;
}

// A free slot of the bucket, or that of the voxel not touched for longest.
std::size_t VoxelMap::MakeRoom(std::uint64_t key) {
  const std::size_t bucket = HashKey(key) % kBuckets;
  std::size_t best = bucket * kWays;
  for (std::size_t i = 0; i < kWays; ++i) {
    const std::size_t slot = bucket * kWays + i;
    if (keys_[bucket].key[i] == 0) {
      best = slot;
      break;
    }
    if (touched_scan_[slot] < touched_scan_[best]) best = slot;
  }
  if (keys_[bucket].key[best % kWays] != 0) ++evicted_;
  keys_[bucket].key[best % kWays] = key;
  count_[best] = 0;
  voxels_[best] = Voxel{};
  return best;
}

Status VoxelMap::Insert(const Eigen::Vector3f& p_odom) {
  const Eigen::Vector3f scaled = p_odom / config_.voxel_m;
  if (!scaled.allFinite() || scaled.cwiseAbs().maxCoeff() >= static_cast<float>(kCellLimit)) return Status::kOutOfRange;
  const Cell cell{CellIndex(scaled.x()), CellIndex(scaled.y()), CellIndex(scaled.z())};
  const std::uint64_t key = PackCell(cell);
  std::size_t slot = Find(key);
  if (slot == kNone) slot = MakeRoom(key);
  touched_scan_[slot] = scan_;
  if (count_[slot] >= config_.mature_points) return Status::kOk;
  ++count_[slot];
  Voxel& voxel = voxels_[slot];
  const Eigen::Vector3f d = p_odom - CellCentre(cell, config_.voxel_m);
  voxel.sum[0] += d.x();
  voxel.sum[1] += d.y();
  voxel.sum[2] += d.z();
  voxel.sum_sq[0] += d.x() * d.x();
  voxel.sum_sq[1] += d.x() * d.y();
  voxel.sum_sq[2] += d.x() * d.z();
  voxel.sum_sq[3] += d.y() * d.y();
  voxel.sum_sq[4] += d.y() * d.z();
  voxel.sum_sq[5] += d.z() * d.z();
  return Status::kOk;
}

void VoxelMap::FitPlane(const Cell& cell, std::uint32_t count, Voxel* voxel) const {
  voxel->fitted_count = count;
  const double n = count;
  const geom::Vec3d mean = Eigen::Map<const Eigen::Vector3f>(voxel->sum.data()).cast<double>() / n;
  const Eigen::Matrix<double, 6, 1> s =
      Eigen::Map<const Eigen::Matrix<float, 6, 1>>(voxel->sum_sq.data()).cast<double>();
  geom::Mat3d second;
  second << s(0), s(1), s(2), s(1), s(3), s(4), s(2), s(4), s(5);
  const geom::Mat3d covariance = second / n - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<geom::Mat3d> solver;
  solver.computeDirect(covariance);
  const geom::Vec3d widths = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  voxel->flat = widths(0) <= static_cast<double>(config_.max_thickness_m) &&
                widths(1) >= static_cast<double>(config_.min_width_m) && widths(1) > 2.5 * widths(0);
  if (!voxel->flat) return;
  const Eigen::Vector3f centre = CellCentre(cell, config_.voxel_m) + mean.cast<float>();
  const Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>();
  for (int i = 0; i < 3; ++i) {
    voxel->mean[static_cast<std::size_t>(i)] = centre(i);
    voxel->normal[static_cast<std::size_t>(i)] = normal(i);
  }
  voxel->variance = static_cast<float>(widths(0) * widths(0));
  voxel->tilt_variance = static_cast<float>(widths(0) * widths(0) / (n * widths(1) * widths(1)));
}

bool VoxelMap::FindPlane(const Eigen::Vector3f& p_odom, Plane* plane) {
  const Eigen::Vector3f scaled = p_odom / config_.voxel_m;
  if (!scaled.allFinite() || scaled.cwiseAbs().maxCoeff() >= static_cast<float>(kCellLimit - 1)) return false;
  const Cell own{CellIndex(scaled.x()), CellIndex(scaled.y()), CellIndex(scaled.z())};
  const auto nearer = [&scaled](int axis, std::int32_t cell) {
    return scaled(axis) - static_cast<float>(cell) < 0.5F ? -1 : 1;
  };
  const std::int32_t near[4][3] = {
      {0, 0, 0}, {nearer(0, own.x), 0, 0}, {0, nearer(1, own.y), 0}, {0, 0, nearer(2, own.z)}};
  float best = config_.voxel_m * config_.voxel_m;
  bool found = false;
  for (const auto& step : near) {
    const Cell cell{own.x + step[0], own.y + step[1], own.z + step[2]};
    const std::size_t slot = Find(PackCell(cell));
    if (slot == kNone || count_[slot] < config_.min_points) continue;
    touched_scan_[slot] = scan_;
    Voxel& voxel = voxels_[slot];
    // Refit only when a quarter of the points is new: bounds the eigenvalue work per voxel to a logarithm of its
    // points.
    if (count_[slot] >= voxel.fitted_count + voxel.fitted_count / 4 + 1) FitPlane(cell, count_[slot], &voxel);
    if (!voxel.flat) continue;
    const Eigen::Vector3f mean(voxel.mean[0], voxel.mean[1], voxel.mean[2]);
    const float distance = (p_odom - mean).squaredNorm();
    if (distance >= best) continue;
    best = distance;
    found = true;
    *plane = {mean, Eigen::Vector3f(voxel.normal[0], voxel.normal[1], voxel.normal[2]), voxel.variance,
              voxel.tilt_variance};
  }
  return found;
}

}  // namespace mapweld::lio
