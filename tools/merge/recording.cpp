// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "tools/merge/keyframe_submaps.hpp"
#include "tools/merge/parallel.hpp"

namespace mapweld::merge {
namespace {

using geom::Pose3;
using geom::Quatd;
using geom::Vec3d;

void Check(const Recording& recording) {
  if (recording.world_T_lidar.size() < 2) {
    throw std::runtime_error(fmt::format("{}: a drive needs at least two scans with poses", recording.name));
  }
  if (recording.times.size() != recording.world_T_lidar.size()) {
    throw std::runtime_error(fmt::format("{}: {} times for {} poses; both must have one entry per scan", recording.name,
                                         recording.times.size(), recording.world_T_lidar.size()));
  }
  for (std::size_t i = 0; i < recording.world_T_lidar.size(); ++i) {
    if (!recording.world_T_lidar[i].IsValid()) {
      throw std::runtime_error(fmt::format("{}: pose {} is not a rigid transform", recording.name, i));
    }
  }
}

void SetOdometry(const Recording& recording, RecordedDrive* out) {
  const Quatd odom_R_world = LevelingRotation(recording.world_T_lidar);
  out->odom_T_world = {-(odom_R_world * recording.world_T_lidar.front().t), odom_R_world};
  double path_m = 0;
  for (const Pose3& world_T_lidar : recording.world_T_lidar) {
    const Pose3 odom_T_scan = out->odom_T_world * world_T_lidar;
    if (!out->odom_T_scan.empty()) path_m += (odom_T_scan.t - out->odom_T_scan.back().t).norm();
    out->odom_T_scan.push_back(odom_T_scan);
    out->scan_path_m.push_back(path_m);
  }
}

// The scan at or first after every multiple of the spacing.
std::vector<int> ChooseKeyframes(const std::vector<double>& scan_path_m, double spacing_m) {
  std::vector<int> scans;
  double next_m = 0;
  for (std::size_t i = 0; i < scan_path_m.size(); ++i) {
    if (scan_path_m[i] < next_m) continue;
    scans.push_back(static_cast<int>(i));
    next_m = scan_path_m[i] + spacing_m;
  }
  return scans;
}

}  // namespace

Quatd LevelingRotation(const std::vector<Pose3>& world_T_lidar) {
  Vec3d up = Vec3d::Zero();
  for (const Pose3& pose : world_T_lidar) up += pose.q * Vec3d::UnitZ();
  if (up.norm() < 1e-6) return Quatd::Identity();
  return geom::RotationBetween(up.normalized(), Vec3d::UnitZ());
}

RecordedDrive BuildDrive(const Recording& recording, const RecordingConfig& config, Progress* progress) {
  Check(recording);
  RecordedDrive out;
  out.drive.name = recording.name;
  SetOdometry(recording, &out);
  const std::vector<int> keyframe_scans = ChooseKeyframes(out.scan_path_m, config.keyframe_spacing_m);
  const int count = static_cast<int>(keyframe_scans.size());
  out.submaps.resize(keyframe_scans.size());
  for (const int scan : keyframe_scans) {
    const auto i = static_cast<std::size_t>(scan);
    Keyframe keyframe;
    keyframe.t = recording.times[i];
    keyframe.odom_T_body = out.odom_T_scan[i];
    keyframe.path_m = out.scan_path_m[i];
    keyframe.flushed = out.scan_path_m.back() - keyframe.path_m < config.path_window_m;
    out.drive.keyframes.push_back(keyframe);
  }
  // Neighbouring keyframes share most of their scans, so a job is a run of them.
  const int run = std::clamp(count / ThreadCount(config.threads), 1, 48);
  const int jobs = (count + run - 1) / run;
  std::mutex report;
  int done = 0;
  ParallelFor(jobs, config.threads, [&](int job) {
    SubmapBuilder builder(recording, config, out.odom_T_scan, out.scan_path_m);
    for (int k = job * run; k < std::min(count, (job + 1) * run); ++k) {
      const auto i = static_cast<std::size_t>(k);
      builder.Build(keyframe_scans[i], k, &out.submaps[i], &out.drive.keyframes[i].place);
      if (progress == nullptr) continue;
      const std::lock_guard lock(report);
      progress->Report("submaps", ++done, count);
    }
  });
  return out;
}

std::vector<Pose3> MergedScanPoses(const RecordedDrive& recorded, const std::vector<Pose3>& merged_T_body) {
  const std::vector<Keyframe>& keyframes = recorded.drive.keyframes;
  if (merged_T_body.size() != keyframes.size()) {
    throw std::runtime_error(fmt::format("{}: {} merged poses for {} keyframes", recorded.drive.name,
                                         merged_T_body.size(), keyframes.size()));
  }
  std::vector<Pose3> merged_T_scan;
  std::size_t k = 0;
  for (std::size_t i = 0; i < recorded.odom_T_scan.size(); ++i) {
    const double path_m = recorded.scan_path_m[i];
    while (k + 1 < keyframes.size() && keyframes[k + 1].path_m <= path_m) ++k;
    const auto moved = [&](std::size_t keyframe) {
      return merged_T_body[keyframe] * (keyframes[keyframe].odom_T_body.Inverse() * recorded.odom_T_scan[i]);
    };
    const Pose3 from_before = moved(k);
    if (k + 1 == keyframes.size()) {
      merged_T_scan.push_back(from_before);
      continue;
    }
    const Pose3 from_after = moved(k + 1);
    const double share = (path_m - keyframes[k].path_m) / (keyframes[k + 1].path_m - keyframes[k].path_m);
    merged_T_scan.push_back(
        {(1 - share) * from_before.t + share * from_after.t, from_before.q.slerp(share, from_after.q).normalized()});
  }
  return merged_T_scan;
}

std::shared_ptr<const SubmapCloud> RecordedSubmaps::Find(SubmapKey key) {
  const auto drive = static_cast<std::size_t>(key.drive);
  const auto keyframe = static_cast<std::size_t>(key.keyframe);
  if (key.drive < 0 || drive >= drives_->size()) return nullptr;
  if (key.keyframe < 0 || keyframe >= (*drives_)[drive].submaps.size()) return nullptr;
  return Kept(&(*drives_)[drive].submaps[keyframe]);
}

}  // namespace mapweld::merge
