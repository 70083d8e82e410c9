// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/odometry_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
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

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) /
         static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

std::string TimeLine(const char* what, const std::vector<double>& ms) {
  const double median = Quantile(ms, 0.5);
  return fmt::format(
      "CPU ms per scan, {:<22} median {:.2f}, 99th percentile {:.2f} ({:.2f} x), max {:.2f}, mean {:.2f}\n", what,
      median, Quantile(ms, 0.99), Quantile(ms, 0.99) / std::max(median, 1e-9), Quantile(ms, 1.0), Mean(ms));
}

struct PathError {
  double path_m = 0;
  double end_m = 0;
  eval::ErrorStatistics aligned;
  eval::SegmentError drift;
  std::vector<double> gravity_deg;
};

PathError ErrorsOf(const std::vector<io::StampedPose>& truth, const std::vector<io::StampedPose>& estimate) {
  std::vector<io::StampedPose> true_poses;
  std::vector<io::StampedPose> poses;
  PathError error;
  for (const io::StampedPose& pose : estimate) {
    geom::Pose3 at;
    if (!eval::TruthAt(truth, pose.t, &at)) continue;
    if (!poses.empty()) error.path_m += (at.t - true_poses.back().world_T_body.t).norm();
    true_poses.push_back({pose.t, at});
    poses.push_back(pose);
  }
  if (poses.empty()) return error;
  const geom::Pose3 moved = poses.front().world_T_body.Inverse() * poses.back().world_T_body;
  const geom::Pose3 truly = true_poses.front().world_T_body.Inverse() * true_poses.back().world_T_body;
  error.end_m = (moved.t - truly.t).norm();
  error.drift = eval::SegmentDrift(true_poses, poses);
  error.aligned = eval::EvaluateGroup({{"odometry", true_poses, poses}}).all;
  error.gravity_deg = eval::GravityErrorsDeg(true_poses, poses);
  return error;
}

std::string ErrorLines(const std::vector<io::StampedPose>& truth, const std::vector<io::StampedPose>& estimate) {
  const PathError error = ErrorsOf(truth, estimate);
  if (error.gravity_deg.empty()) return "no pose has truth at its time\n";
  return fmt::format(
      "path {:.1f} m, end point off by {:.3f} m ({:.3f} %), rmse {:.3f} m and max {:.3f} m after one alignment\n"
      "KITTI segments ({}): {:.3f} % and {:.5f} deg/m\n"
      "gravity: median {:.3f}, 99th percentile {:.3f}, max {:.3f} degrees\n",
      error.path_m, error.end_m, 100 * error.end_m / std::max(error.path_m, 1e-9), error.aligned.rmse_m,
      error.aligned.max_m, error.drift.segments, error.drift.translation_percent, error.drift.rotation_deg_per_m,
      Quantile(error.gravity_deg, 0.5), Quantile(error.gravity_deg, 0.99), Quantile(error.gravity_deg, 1.0));
}

}  // namespace

std::vector<io::StampedPose> Trajectory(const OdometryRun& run) {
  std::vector<io::StampedPose> poses;
  for (const ScanRecord& scan : run.scans) poses.push_back({scan.update.t, scan.update.odom_T_body});
  return poses;
}

std::string Report(const OdometryRun& run, const std::vector<io::StampedPose>& truth) {
  std::vector<double> odometry_ms;
  std::vector<double> cpu_ms;
  std::vector<double> residual_m;
  std::size_t degenerate = 0;
  std::size_t uncorrected = 0;
  double largest_sigma_m = 0;
  std::vector<double> surprise;
  for (const ScanRecord& scan : run.scans) {
    odometry_ms.push_back(scan.odometry_ms);
    cpu_ms.push_back(scan.cpu_ms);
    surprise.push_back(scan.update.surprise);
    residual_m.push_back(scan.update.residual_rms_m);
    degenerate += scan.update.degenerate ? 1 : 0;
    uncorrected += scan.update.corrected ? 0 : 1;
    largest_sigma_m = std::max(largest_sigma_m, scan.update.sigma_m);
  }
  std::string text = truth.empty() ? "" : ErrorLines(truth, Trajectory(run));
  text += fmt::format(
      "{} scans, {} dropped; {} degenerate, {} uncorrected; residual {:.4f} m (median); largest sigma {:.3f} m; "
      "surprise {:.3f} (median), {:.2f} (max)\n",
      run.counters.scans, run.counters.scans_dropped, degenerate, uncorrected, Quantile(residual_m, 0.5),
      largest_sigma_m, Quantile(surprise, 0.5), Quantile(surprise, 1.0));
  text += TimeLine("odometry:", odometry_ms);
  if (run.keyframes.empty()) return text;
  text += TimeLine("with submaps:", cpu_ms);
  std::vector<double> points;
  std::vector<double> kilobytes;
  for (const KeyframeRecord& keyframe : run.keyframes) {
    points.push_back(static_cast<double>(keyframe.points));
    kilobytes.push_back(1e-3 * static_cast<double>(keyframe.encoded.size()));
  }
  return text + fmt::format("{} submaps of {:.0f} points and {:.1f} kB (mean; largest {:.1f} kB)\n",
                            run.keyframes.size(), Mean(points), Mean(kilobytes), Quantile(kilobytes, 1.0));
}

std::string ReportJson(const OdometryRun& run, const std::vector<io::StampedPose>& truth) {
  nlohmann::ordered_json json;
  if (!truth.empty()) {
    const PathError error = ErrorsOf(truth, Trajectory(run));
    json["path_m"] = error.path_m;
    json["end_m"] = error.end_m;
    json["rmse_m"] = error.aligned.rmse_m;
    json["segments"] = error.drift.segments;
    json["drift_percent"] = error.drift.translation_percent;
    json["drift_deg_per_m"] = error.drift.rotation_deg_per_m;
    json["gravity_max_deg"] = Quantile(error.gravity_deg, 1.0);
  }
  for (const ScanRecord& scan : run.scans) {
    json["scans"].push_back({{"t_ns", scan.update.t.ns},
                             {"odometry_ms", scan.odometry_ms},
                             {"cpu_ms", scan.cpu_ms},
                             {"inliers", scan.update.inliers},
                             {"sigma_m", scan.update.sigma_m},
                             {"surprise", scan.update.surprise},
                             {"position_information", scan.update.degeneracy.position_information},
                             {"degenerate", scan.update.degenerate},
                             {"corrected", scan.update.corrected}});
  }
  return json.dump(1) + '\n';
}

}  // namespace mapweld::odometry
