// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/keyframe_submaps.hpp"

#include <algorithm>
#include <cmath>

namespace mapweld::merge {

using geom::Pose3;

SubmapBuilder::SubmapBuilder(const Recording& recording, const RecordingConfig& config,
                             const std::vector<Pose3>& odom_T_scan, const std::vector<double>& scan_path_m)
    : recording_(&recording),
      config_(config),
      odom_T_scan_(&odom_T_scan),
      scan_path_m_(&scan_path_m),
      scan_voxels_(config.scan_voxel_m),
      submap_voxels_(config.voxel_m),
      describer_(std::make_unique<place::Describer>()),
      submap_(std::make_unique<submap::Submap>()) {}

const std::vector<WeightedPoint>& SubmapBuilder::Scan(int scan) {
  auto [at, is_new] = scans_.try_emplace(scan);
  if (is_new) {
    for (const Eigen::Vector3f& p : recording_->load_scan(scan)) scan_voxels_.Add(p, 1.0F);
    scan_voxels_.Take(&at->second);
  }
  return at->second;
}

// The first scan in every stretch of scan_spacing_m: a rule that does not depend on the keyframe.
bool SubmapBuilder::Used(int scan) const {
  if (scan == 0) return true;
  const auto stretch = [&](int i) {
    return std::floor((*scan_path_m_)[static_cast<std::size_t>(i)] / config_.scan_spacing_m);
  };
  return stretch(scan) != stretch(scan - 1);
}

void SubmapBuilder::Build(int keyframe_scan, int keyframe, SubmapCloud* cloud, place::PlaceDescription* place) {
  const double path_m = (*scan_path_m_)[static_cast<std::size_t>(keyframe_scan)];
  const auto index_at = [&](double at_m) {
    return static_cast<int>(std::lower_bound(scan_path_m_->begin(), scan_path_m_->end(), at_m) - scan_path_m_->begin());
  };
  const int first = index_at(path_m - config_.path_window_m);
  const int last = std::min(index_at(path_m + config_.path_window_m), static_cast<int>(scan_path_m_->size()) - 1);
  scans_.erase(scans_.begin(), scans_.lower_bound(first));

  const Pose3 level_T_odom = geom::Level((*odom_T_scan_)[static_cast<std::size_t>(keyframe_scan)]).Inverse();
  const auto radius = static_cast<float>(config_.radius_m);
  for (int scan = first; scan <= last; ++scan) {
    if (!Used(scan) && scan != keyframe_scan) continue;
    const Pose3 level_T_scan = level_T_odom * (*odom_T_scan_)[static_cast<std::size_t>(scan)];
    const Eigen::Matrix3f rotation = level_T_scan.q.toRotationMatrix().cast<float>();
    const Eigen::Vector3f translation = level_T_scan.t.cast<float>();
    for (const WeightedPoint& point : Scan(scan)) {
      const Eigen::Vector3f p = rotation * point.p + translation;
      if (p.head<2>().squaredNorm() <= radius * radius) submap_voxels_.Add(p, point.weight);
    }
  }
  submap_voxels_.Take(&points_);

  cloud->points.clear();
  cloud->points.reserve(points_.size());
  submap_->keyframe = keyframe;
  submap_->t = recording_->times[static_cast<std::size_t>(keyframe_scan)];
  submap_->voxel_m = static_cast<float>(config_.voxel_m);
  submap_->radius_m = radius;
  submap_->flushed = scan_path_m_->back() - path_m < config_.path_window_m;
  submap_->points.clear();
  for (const WeightedPoint& point : points_) {
    cloud->points.push_back(point.p);
    const auto count = static_cast<std::uint16_t>(std::min(point.weight, 65535.0F));
    if (submap_->points.TryPush({point.p.x(), point.p.y(), point.p.z(), count, 0}) != Status::kOk) break;
  }
  if (describer_->Describe(*submap_, place) != Status::kOk) *place = place::PlaceDescription{};
}

}  // namespace mapweld::merge
