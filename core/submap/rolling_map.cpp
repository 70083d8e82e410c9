// SPDX-License-Identifier: Apache-2.0
#include "core/submap/rolling_map.hpp"

#include <algorithm>
#include <cmath>

namespace mapweld::submap {
namespace {

constexpr float kOffsetSteps = 1024.0F;
constexpr std::uint16_t kMaxCount = 65535;
constexpr double kVotePath_m = 60;  // voxels that were last seen farther back are out of sight

}  // namespace

// A free slot of the key's bucket, or that of the voxel seen longest ago.
std::size_t RollingMap::MakeRoom(std::uint64_t key) {
  const std::size_t bucket = HashKey(key) % kBuckets;
  std::size_t best = bucket * kWays;
  for (std::size_t slot = best; slot < (bucket + 1) * kWays; ++slot) {
    if (KeyOf(slot) == 0) {
      best = slot;
      break;
    }
    if (voxels_[slot].seen_dm < voxels_[best].seen_dm) best = slot;
  }
  if (KeyOf(best) != 0) ++evicted_;
  keys_[bucket].key[best % kWays] = key;
  voxels_[best] = Voxel{};
  return best;
}

Status RollingMap::Insert(const Eigen::Vector3f& p_odom, double path_m) {
  const Eigen::Vector3f scaled = p_odom / config_.voxel_m;
  if (!scaled.allFinite() || scaled.cwiseAbs().maxCoeff() >= static_cast<float>(kCellLimit)) return Status::kOutOfRange;
  const Cell cell{CellIndex(scaled.x()), CellIndex(scaled.y()), CellIndex(scaled.z())};
  const std::uint64_t key = PackCell(cell);
  const std::size_t bucket = HashKey(key) % kBuckets;
  std::size_t slot = kCap.submap_map_voxels;
  for (std::size_t i = 0; i < kWays; ++i) {
    if (keys_[bucket].key[i] == key) slot = bucket * kWays + i;
  }
  if (slot == kCap.submap_map_voxels) slot = MakeRoom(key);
  Voxel& voxel = voxels_[slot];
  voxel.seen_dm = static_cast<std::uint32_t>(path_m * 10.0);
  if (voxel.count == kMaxCount) return Status::kOk;
  ++voxel.count;
  voxel.sum[0] += static_cast<std::int32_t>((scaled.x() - static_cast<float>(cell.x)) * kOffsetSteps);
  voxel.sum[1] += static_cast<std::int32_t>((scaled.y() - static_cast<float>(cell.y)) * kOffsetSteps);
  voxel.sum[2] += static_cast<std::int32_t>((scaled.z() - static_cast<float>(cell.z)) * kOffsetSteps);
  return Status::kOk;
}

geom::Vec3d RollingMap::MeanOf(const Cell& cell, const Voxel& voxel) const {
  const auto to_m = static_cast<double>(config_.voxel_m);
  const double per_count = 1.0 / (static_cast<double>(kOffsetSteps) * voxel.count);
  return {(cell.x + voxel.sum[0] * per_count) * to_m, (cell.y + voxel.sum[1] * per_count) * to_m,
          (cell.z + voxel.sum[2] * per_count) * to_m};
}

void RollingMap::Vote(const RangeImage& image, const Eigen::Vector3f& centre_odom, double path_m) {
  constexpr std::size_t kSlice = kCap.submap_map_voxels / kVoteSlices;
  const auto seen_from_dm = static_cast<std::uint32_t>(std::max(0.0, path_m - kVotePath_m) * 10.0);
  const float reach = RangeImage::kMaxRange_m / config_.voxel_m;
  const Eigen::Vector3f centre = centre_odom / config_.voxel_m;
  for (std::size_t slot = vote_slice_ * kSlice; slot < (vote_slice_ + 1) * kSlice; ++slot) {
    Voxel& voxel = voxels_[slot];
    if (KeyOf(slot) == 0 || voxel.seen_dm < seen_from_dm) continue;
    const Cell cell = UnpackCell(KeyOf(slot));
    if (std::abs(static_cast<float>(cell.x) - centre.x()) > reach) continue;
    if (std::abs(static_cast<float>(cell.y) - centre.y()) > reach) continue;
    const Sight sight = image.Look(MeanOf(cell, voxel).cast<float>());
    if (sight == Sight::kUnknown) continue;
    std::uint8_t& votes = sight == Sight::kSurface ? voxel.seen : voxel.through;
    if (++votes < 255) continue;
    voxel.seen = static_cast<std::uint8_t>(voxel.seen / 2U);
    voxel.through = static_cast<std::uint8_t>(voxel.through / 2U);
  }
  vote_slice_ = (vote_slice_ + 1) % kVoteSlices;
}

bool RollingMap::Moved(const Voxel& voxel) const {
  const std::uint32_t looks = std::uint32_t{voxel.seen} + voxel.through;
  return voxel.through >= config_.min_through && voxel.through > config_.max_through_share * looks;
}

void RollingMap::BeginCut(const geom::Pose3& odom_T_body, double path_m, Submap* submap) {
  const geom::Pose3 level_T_odom = geom::Level(odom_T_body).Inverse();
  cut_.step = 0;
  cut_.status = Status::kOk;
  cut_.centre_odom = odom_T_body.t;
  cut_.level_R_odom = level_T_odom.q.toRotationMatrix();
  cut_.level_t_odom = level_T_odom.t;
  cut_.seen_from_dm = static_cast<std::uint32_t>(std::max(0.0, (path_m - config_.reach_m) * 10.0));
  cut_.seen_to_dm = static_cast<std::uint32_t>((path_m + config_.reach_m) * 10.0);
  submap->voxel_m = config_.voxel_m;
  submap->radius_m = config_.radius_m;
  submap->points.clear();
  found_.clear();
}

void RollingMap::Collect(std::size_t from, std::size_t to, Submap* submap) {
  const geom::Vec3d centre = cut_.centre_odom / static_cast<double>(config_.voxel_m);
  const auto reach = static_cast<double>(config_.radius_m / config_.voxel_m) + 2;
  for (std::size_t slot = from; slot < to; ++slot) {
    const Voxel& voxel = voxels_[slot];
    if (KeyOf(slot) == 0 || voxel.seen_dm < cut_.seen_from_dm || voxel.seen_dm > cut_.seen_to_dm) continue;
    const Cell cell = UnpackCell(KeyOf(slot));
    if (std::abs(cell.x - centre.x()) > reach || std::abs(cell.y - centre.y()) > reach) continue;
    if (Moved(voxel)) continue;
    const Eigen::Vector3f p = (cut_.level_R_odom * MeanOf(cell, voxel) + cut_.level_t_odom).cast<float>();
    if (p.squaredNorm() > config_.radius_m * config_.radius_m) continue;
    const SubmapPoint point{p.x(), p.y(), p.z(), voxel.count, 0};
    Found found{0, static_cast<std::uint32_t>(submap->points.size())};
    if (!CellKey(point, config_.voxel_m, &found.cell)) continue;
    if (found_.TryPush(found) != Status::kOk) {
      cut_.status = Status::kFull;
      return;
    }
    (void)submap->points.TryPush(point);  // same capacity
  }
}

// Radix sort by cell, 8 bits at a time; the points of one cell by their place in it, so that the order does not depend
// on where the hash put them. Then the points are brought into that order, one cycle of the permutation after another.
void RollingMap::Sort(Submap* submap) {
  for (unsigned shift = 0; shift < 24; shift += 8) {
    std::array<std::uint32_t, 257> begin{};
    for (const Found& found : found_) ++begin[((found.cell >> shift) & 0xFFU) + 1];
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    sorted_.resize(found_.size());
    for (const Found& found : found_) sorted_[begin[(found.cell >> shift) & 0xFFU]++] = found;
    std::copy(sorted_.begin(), sorted_.end(), found_.begin());
  }
  FixedVector<SubmapPoint, kCap.submap_points>& points = submap->points;
  const auto before = [&points](const Found& a, const Found& b) {
    const SubmapPoint& p = points[a.point];
    const SubmapPoint& q = points[b.point];
    if (p.x != q.x) return p.x < q.x;
    if (p.y != q.y) return p.y < q.y;
    return p.z != q.z ? p.z < q.z : p.count < q.count;
  };
  for (std::size_t i = 1; i < found_.size(); ++i) {
    for (std::size_t k = i; k > 0 && found_[k - 1].cell == found_[k].cell && before(found_[k], found_[k - 1]); --k) {
      std::swap(found_[k - 1], found_[k]);
    }
  }
  for (std::size_t i = 0; i < found_.size(); ++i) {
    const SubmapPoint first = points[i];
    std::size_t to = i;
    while (found_[to].point != i) {
      const std::size_t from = found_[to].point;
      points[to] = points[from];
      found_[to].point = static_cast<std::uint32_t>(to);
      to = from;
    }
    points[to] = first;
    found_[to].point = static_cast<std::uint32_t>(to);
  }
}

Status RollingMap::CutStep(Submap* submap) {
  constexpr std::size_t kSlices = kCutSteps - 1;
  constexpr std::size_t kSlice = kCap.submap_map_voxels / kSlices;
  if (cut_.step < kSlices) Collect(cut_.step * kSlice, (cut_.step + 1) * kSlice, submap);
  if (cut_.step == kSlices) Sort(submap);
  ++cut_.step;
  return cut_.status;
}

Status RollingMap::Extract(const geom::Pose3& odom_T_body, double path_m, Submap* submap) {
  BeginCut(odom_T_body, path_m, submap);
  for (std::size_t i = 0; i < kCutSteps; ++i) (void)CutStep(submap);
  return cut_.status;
}

}  // namespace mapweld::submap
