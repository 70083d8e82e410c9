// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/submap_agreement.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <unordered_map>

#include "core/base/voxel_key.hpp"
#include "core/submap/submap_codec.hpp"
#include "tools/eval/trajectory_error.hpp"

namespace mapweld::odometry {
namespace {

constexpr float kEdge_m = 0.5F;
constexpr float kRadius_m = 45.0F;

std::uint64_t KeyOf(const Eigen::Vector3f& p, int dx = 0, int dy = 0, int dz = 0) {
  return PackCell({CellIndex(p.x() / kEdge_m) + dx, CellIndex(p.y() / kEdge_m) + dy, CellIndex(p.z() / kEdge_m) + dz});
}

// A submap's points in the frame of the pair, with a grid to find neighbours in.
class Cloud {
 public:
  Cloud(const PlacedSubmap& submap, const geom::Pose3& pair_T_world, const geom::Vec3d& other_in_pair) {
    const geom::Pose3 pair_T_level = pair_T_world * submap.world_T_level;
    for (const Eigen::Vector3f& p : submap.points) {
      const geom::Vec3d q = pair_T_level * p.cast<double>();
      if ((q - other_in_pair).norm() > static_cast<double>(kRadius_m) || p.norm() > kRadius_m) continue;
      points_.push_back(q.cast<float>());
      cells_[KeyOf(points_.back())].push_back(points_.back());
    }
  }
  [[nodiscard]] double ShareIn(const Cloud& other) const {
    std::size_t shared = 0;
    for (const Eigen::Vector3f& p : points_) shared += other.HasNear(p) ? 1U : 0U;
    return points_.empty() ? 0 : static_cast<double>(shared) / static_cast<double>(points_.size());
  }
  [[nodiscard]] double SameVoxel(const Cloud& other) const {
    std::size_t both = 0;
    for (const auto& [key, points] : cells_) both += other.cells_.contains(key) ? 1U : 0U;
    const std::size_t either = cells_.size() + other.cells_.size() - both;
    return either == 0 ? 0 : static_cast<double>(both) / static_cast<double>(either);
  }

 private:
  [[nodiscard]] bool HasNear(const Eigen::Vector3f& p) const {
    for (int i = 0; i < 27; ++i) {
      const auto cell = cells_.find(KeyOf(p, i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
      if (cell == cells_.end()) continue;
      for (const Eigen::Vector3f& q : cell->second) {
        if ((p - q).norm() <= kEdge_m) return true;
      }
    }
    return false;
  }
  std::vector<Eigen::Vector3f> points_;
  std::unordered_map<std::uint64_t, std::vector<Eigen::Vector3f>> cells_;
};

void Add(const PlacedSubmap& a, const PlacedSubmap& b, Agreement* sum) {
  const geom::Pose3 pair_T_world = a.world_T_level.Inverse();
  const Cloud cloud_a(a, pair_T_world, pair_T_world * b.world_T_level.t);
  const Cloud cloud_b(b, pair_T_world, geom::Vec3d::Zero());
  ++sum->pairs;
  sum->a_in_b += cloud_a.ShareIn(cloud_b);
  sum->b_in_a += cloud_b.ShareIn(cloud_a);
  sum->same_voxel += cloud_a.SameVoxel(cloud_b);
}

void Divide(Agreement* sum) {
  if (sum->pairs == 0) return;
  const auto n = static_cast<double>(sum->pairs);
  sum->a_in_b /= n;
  sum->b_in_a /= n;
  sum->same_voxel /= n;
}

std::string Line(const char* name, const Agreement& a) {
  if (a.pairs == 0) return fmt::format("{:<14} no pair of submaps\n", name);
  return fmt::format(
      "{:<14} {:>5} pairs; within 0.5 m: {:.1f} % of this drive's points, {:.1f} % of the other's; "
      "same voxel {:.1f} %\n",
      name, a.pairs, 100 * a.a_in_b, 100 * a.b_in_a, 100 * a.same_voxel);
}

}  // namespace

std::vector<PlacedSubmap> PlaceSubmaps(const OdometryRun& run, const std::vector<io::StampedPose>& world_T_body) {
  const auto submap = std::make_unique<submap::Submap>();
  std::vector<PlacedSubmap> placed;
  for (const KeyframeRecord& keyframe : run.keyframes) {
    geom::Pose3 truth;
    if (keyframe.flushed || !eval::TruthAt(world_T_body, keyframe.t, &truth)) continue;
    if (submap::DecodeSubmap(keyframe.encoded, submap.get()) != Status::kOk) continue;
    placed.push_back({geom::Level(truth), {}});
    for (const submap::SubmapPoint& p : submap->points) placed.back().points.emplace_back(p.x, p.y, p.z);
  }
  return placed;
}

BothWays CompareSubmaps(const std::vector<PlacedSubmap>& a, const std::vector<PlacedSubmap>& b) {
  BothWays out;
  for (const PlacedSubmap& of_a : a) {
    const PlacedSubmap* nearest[2] = {nullptr, nullptr};  // same way, opposite
    double nearest_m[2] = {kPairApart_m, kPairApart_m};
    for (const PlacedSubmap& of_b : b) {
      const geom::Pose3 apart = of_a.world_T_level.Inverse() * of_b.world_T_level;
      const double turn = std::abs(geom::Yaw(apart.q));
      if (turn > 0.5 && turn < M_PI - 0.5) continue;
      const std::size_t way = turn < 0.5 ? 0 : 1;
      if (apart.t.norm() >= nearest_m[way]) continue;
      nearest_m[way] = apart.t.norm();
      nearest[way] = &of_b;
    }
    if (nearest[0] != nullptr) Add(of_a, *nearest[0], &out.same_way);
    if (nearest[1] != nullptr) Add(of_a, *nearest[1], &out.opposite);
  }
  Divide(&out.same_way);
  Divide(&out.opposite);
  return out;
}

std::string Report(const BothWays& agreement) {
  return Line("same way:", agreement.same_way) + Line("opposite way:", agreement.opposite);
}

}  // namespace mapweld::odometry
