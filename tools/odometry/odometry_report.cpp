// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/odometry_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/eval/segment_error.hpp"
#include "tools/eval/trajectory_error.hpp"

namespace mapweld::odometry {
namespace {

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

double Mean(const std::vector<std::size_t>& values) {
  if (values.empty()) return 0;
  return static_cast<double>(std::accumulate(values.begin(), values.end(), std::size_t{0})) /
         static_cast<double>(values.size());
}

std::string ErrorLines(const std::vector<io::StampedPose>& truth, const std::vector<io::StampedPose>& estimate) {
  std::vector<io::StampedPose> true_poses;
  std::vector<io::StampedPose> poses;
  double path_m = 0;
  for (const io::StampedPose& pose : estimate) {
    geom::Pose3 at;
    if (!eval::TruthAt(truth, pose.t, &at)) continue;
    if (!poses.empty()) path_m += (at.t - true_poses.back().world_T_body.t).norm();
    true_poses.push_back({pose.t, at});
    poses.push_back(pose);
  }
  if (poses.empty()) return "no pose has truth at its time\n";
  const geom::Pose3 moved = poses.front().world_T_body.Inverse() * poses.back().world_T_body;
  const geom::Pose3 truly = true_poses.front().world_T_body.Inverse() * true_poses.back().world_T_body;
  const double end_m = (moved.t - truly.t).norm();
  const eval::SegmentError drift = eval::SegmentDrift(true_poses, poses);
  const eval::GroupError error = eval::EvaluateGroup({{"odometry", true_poses, poses}});
  const std::vector<double> gravity = eval::GravityErrorsDeg(true_poses, poses);
  return fmt::format(
      "path {:.1f} m, end point off by {:.3f} m ({:.3f} %), rmse {:.3f} m and max {:.3f} m after one alignment\n"
      "KITTI segments ({}): {:.3f} % and {:.5f} deg/m\n"
      "gravity: median {:.3f}, 99th percentile {:.3f}, max {:.3f} degrees\n",
      path_m, end_m, 100 * end_m / std::max(path_m, 1e-9), error.all.rmse_m, error.all.max_m, drift.segments,
      drift.translation_percent, drift.rotation_deg_per_m, Quantile(gravity, 0.5), Quantile(gravity, 0.99),
      Quantile(gravity, 1.0));
}

}  // namespace

std::vector<io::StampedPose> Trajectory(const OdometryRun& run) {
  std::vector<io::StampedPose> poses;
  for (const ScanRecord& scan : run.scans) poses.push_back({scan.update.t, scan.update.odom_T_body});
  return poses;
}

std::string Report(const OdometryRun& run, const std::vector<io::StampedPose>& truth) {
  std::vector<double> cpu_ms;
  std::vector<double> residual_m;
  std::size_t degenerate = 0;
  std::size_t uncorrected = 0;
  double largest_sigma_m = 0;
  for (const ScanRecord& scan : run.scans) {
    cpu_ms.push_back(scan.cpu_ms);
    residual_m.push_back(scan.update.residual_rms_m);
    degenerate += scan.update.degenerate ? 1 : 0;
    uncorrected += scan.update.corrected ? 0 : 1;
    largest_sigma_m = std::max(largest_sigma_m, scan.update.sigma_m);
  }
  std::string text = truth.empty() ? "" : ErrorLines(truth, Trajectory(run));
  text += fmt::format(
      "{} scans, {} dropped; {} degenerate, {} uncorrected; residual {:.4f} m (median); largest sigma {:.3f} m\n"
      "CPU ms per scan: median {:.2f}, 99th percentile {:.2f}, max {:.2f}, mean {:.2f}\n",
      run.counters.scans, run.counters.scans_dropped, degenerate, uncorrected, Quantile(residual_m, 0.5),
      largest_sigma_m, Quantile(cpu_ms, 0.5), Quantile(cpu_ms, 0.99), Quantile(cpu_ms, 1.0),
      std::accumulate(cpu_ms.begin(), cpu_ms.end(), 0.0) /
          static_cast<double>(std::max<std::size_t>(cpu_ms.size(), 1)));
  if (!run.submap_bytes.empty()) {
    text +=
        fmt::format("{} submaps of {:.0f} points and {:.1f} kB (mean; largest {:.1f} kB)\n", run.submap_bytes.size(),
                    Mean(run.submap_points), Mean(run.submap_bytes) * 1e-3,
                    static_cast<double>(*std::max_element(run.submap_bytes.begin(), run.submap_bytes.end())) * 1e-3);
  }
  return text;
}

}  // namespace mapweld::odometry
