// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/segment_error.hpp"

#include <cmath>
#include <numbers>

namespace mapweld::eval {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr DurationNs kStartsApart = Milliseconds(1000);

std::vector<double> PathLengths(const std::vector<io::StampedPose>& poses) {
  std::vector<double> path_m(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    path_m[i] = path_m[i - 1] + (poses[i].world_T_body.t - poses[i - 1].world_T_body.t).norm();
  }
  return path_m;
}

constexpr double kStep_m = 10;

// What is left of the estimated motion between two poses when the true one is taken away.
geom::Pose3 MotionError(const std::vector<io::StampedPose>& truth, const std::vector<io::StampedPose>& estimate,
                        std::size_t first, std::size_t last) {
  const geom::Pose3 true_motion = truth[first].world_T_body.Inverse() * truth[last].world_T_body;
  const geom::Pose3 motion = estimate[first].world_T_body.Inverse() * estimate[last].world_T_body;
  return motion.Inverse() * true_motion;
}

}  // namespace

SegmentError SegmentDrift(const std::vector<io::StampedPose>& truth, const std::vector<io::StampedPose>& estimate) {
  const std::vector<double> path_m = PathLengths(truth);
  SegmentError error;
  TimeNs next_start{INT64_MIN};
  for (std::size_t first = 0; first < truth.size(); ++first) {
    if (truth[first].t < next_start) continue;
    next_start = truth[first].t + kStartsApart;
    std::size_t last = first;
    for (double length_m = 100; length_m <= 800; length_m += 100) {
      while (last < truth.size() && path_m[last] < path_m[first] + length_m) ++last;
      if (last == truth.size()) break;
      const geom::Pose3 difference = MotionError(truth, estimate, first, last);
      ++error.segments;
      error.translation_percent += 100 * difference.t.norm() / length_m;
      error.rotation_deg_per_m += geom::LogSo3(difference.q).norm() * kDegrees / length_m;
    }
  }
  if (error.segments == 0) return error;
  error.translation_percent /= static_cast<double>(error.segments);
  error.rotation_deg_per_m /= static_cast<double>(error.segments);
  return error;
}

StepError RelativePoseError(const std::vector<io::StampedPose>& truth, const std::vector<io::StampedPose>& estimate) {
  const std::vector<double> path_m = PathLengths(truth);
  StepError error;
  std::size_t last = 0;
  for (std::size_t first = 0; first < truth.size(); ++first) {
    while (last < truth.size() && path_m[last] < path_m[first] + kStep_m) ++last;
    if (last == truth.size()) break;
    const geom::Pose3 difference = MotionError(truth, estimate, first, last);
    const double turn_deg = geom::LogSo3(difference.q).norm() * kDegrees;
    ++error.steps;
    error.translation_m += difference.t.squaredNorm();
    error.rotation_deg += turn_deg * turn_deg;
  }
  if (error.steps == 0) return error;
  error.translation_m = std::sqrt(error.translation_m / static_cast<double>(error.steps));
  error.rotation_deg = std::sqrt(error.rotation_deg / static_cast<double>(error.steps));
  return error;
}

std::vector<double> GravityErrorsDeg(const std::vector<io::StampedPose>& truth,
                                     const std::vector<io::StampedPose>& estimate) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const geom::Vec3d true_up = truth[i].world_T_body.q.conjugate() * geom::Vec3d::UnitZ();
    const geom::Vec3d up = estimate[i].world_T_body.q.conjugate() * geom::Vec3d::UnitZ();
    errors.push_back(std::atan2(true_up.cross(up).norm(), true_up.dot(up)) * kDegrees);
  }
  return errors;
}

}  // namespace mapweld::eval
