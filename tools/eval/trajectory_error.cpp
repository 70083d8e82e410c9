// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/trajectory_error.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mapweld::eval {
namespace {

constexpr DurationNs kEndSlack = Milliseconds(10);
constexpr DurationNs kLongestGap = Milliseconds(1000);

// Positions and poses with the truth at the same times.
struct Matched {
  std::vector<geom::Vec3d> truth;
  std::vector<geom::Vec3d> estimate;
  std::vector<io::StampedPose> truth_poses;
  std::vector<io::StampedPose> estimate_poses;
};

Matched Match(const Vehicle& vehicle) {
  Matched matched;
  for (const io::StampedPose& pose : vehicle.estimate) {
    geom::Pose3 truth;
    if (!TruthAt(vehicle.truth, pose.t, &truth)) continue;
    matched.truth.push_back(truth.t);
    matched.estimate.push_back(pose.world_T_body.t);
    matched.truth_poses.push_back({pose.t, truth});
    matched.estimate_poses.push_back(pose);
  }
  if (matched.truth.empty()) {
    throw std::runtime_error(
        fmt::format("{}: no estimated pose has truth at its time; check that both use the same clock", vehicle.name));
  }
  return matched;
}

// Files with positions alone have one rotation throughout; a vehicle that drives has not.
bool HasRotations(const std::vector<io::StampedPose>& poses) {
  return std::any_of(poses.begin(), poses.end(), [&](const io::StampedPose& pose) {
    return pose.world_T_body.q.angularDistance(poses.front().world_T_body.q) > 1e-9;
  });
}

std::vector<double> Distances(const Matched& matched, const geom::Pose3& truth_T_estimate) {
  std::vector<double> distances;
  distances.reserve(matched.truth.size());
  for (std::size_t i = 0; i < matched.truth.size(); ++i) {
    distances.push_back((matched.truth[i] - truth_T_estimate * matched.estimate[i]).norm());
  }
  return distances;
}

}  // namespace

ErrorStatistics Statistics(std::vector<double> errors_m) {
  ErrorStatistics s;
  s.count = errors_m.size();
  if (errors_m.empty()) return s;
  double sum = 0;
  double sum_of_squares = 0;
  for (const double e : errors_m) {
    sum += e;
    sum_of_squares += e * e;
  }
  const auto n = static_cast<double>(errors_m.size());
  s.mean_m = sum / n;
  s.rmse_m = std::sqrt(sum_of_squares / n);
  std::sort(errors_m.begin(), errors_m.end());
  s.max_m = errors_m.back();
  const std::size_t half = errors_m.size() / 2;
  s.median_m = errors_m.size() % 2 == 1 ? errors_m[half] : (errors_m[half - 1] + errors_m[half]) / 2;
  return s;
}

bool TruthAt(const std::vector<io::StampedPose>& truth, TimeNs t, geom::Pose3* world_T_body) {
  if (truth.empty() || t < truth.front().t - kEndSlack || t > truth.back().t + kEndSlack) return false;
  const auto after =
      std::lower_bound(truth.begin(), truth.end(), t, [](const io::StampedPose& p, TimeNs time) { return p.t < time; });
  if (after == truth.end() || after->t == t || after == truth.begin()) {
    *world_T_body = (after == truth.end() ? truth.back() : *after).world_T_body;
    return true;
  }
  const auto before = after - 1;
  if (after->t - before->t > kLongestGap) return false;
  const double share = (t - before->t).Seconds() / (after->t - before->t).Seconds();
  world_T_body->t = (1 - share) * before->world_T_body.t + share * after->world_T_body.t;
  world_T_body->q = before->world_T_body.q.slerp(share, after->world_T_body.q);
  return true;
}

geom::Pose3 AlignRigidly(const std::vector<geom::Vec3d>& a, const std::vector<geom::Vec3d>& b) {
  const std::size_t count = std::min(a.size(), b.size());
  if (count == 0) return {};
  geom::Vec3d center_a = geom::Vec3d::Zero();
  geom::Vec3d center_b = geom::Vec3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    center_a += a[i];
    center_b += b[i];
  }
  center_a /= static_cast<double>(count);
  center_b /= static_cast<double>(count);
  geom::Mat3d covariance = geom::Mat3d::Zero();
  for (std::size_t i = 0; i < count; ++i) covariance += (a[i] - center_a) * (b[i] - center_b).transpose();
  const Eigen::JacobiSVD<geom::Mat3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  geom::Mat3d reflect = geom::Mat3d::Identity();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) reflect(2, 2) = -1;
  const geom::Quatd a_R_b(geom::Mat3d(svd.matrixU() * reflect * svd.matrixV().transpose()));
  return {center_a - a_R_b * center_b, a_R_b.normalized()};
}

GroupError EvaluateGroup(const std::vector<Vehicle>& group) {
  std::vector<Matched> matched;
  Matched everything;
  for (const Vehicle& vehicle : group) {
    matched.push_back(Match(vehicle));
    everything.truth.insert(everything.truth.end(), matched.back().truth.begin(), matched.back().truth.end());
    everything.estimate.insert(everything.estimate.end(), matched.back().estimate.begin(),
                               matched.back().estimate.end());
  }
  GroupError error;
  error.truth_T_estimate = AlignRigidly(everything.truth, everything.estimate);
  error.all = Statistics(Distances(everything, error.truth_T_estimate));
  for (std::size_t i = 0; i < group.size(); ++i) {
    VehicleError vehicle;
    vehicle.name = group[i].name;
    vehicle.errors_m = Distances(matched[i], error.truth_T_estimate);
    vehicle.together = Statistics(vehicle.errors_m);
    vehicle.alone = Statistics(Distances(matched[i], AlignRigidly(matched[i].truth, matched[i].estimate)));
    if (HasRotations(matched[i].truth_poses) && HasRotations(matched[i].estimate_poses)) {
      vehicle.step = RelativePoseError(matched[i].truth_poses, matched[i].estimate_poses);
      vehicle.drift = SegmentDrift(matched[i].truth_poses, matched[i].estimate_poses);
    }
    vehicle.unmatched = group[i].estimate.size() - matched[i].truth.size();
    error.vehicles.push_back(std::move(vehicle));
  }
  return error;
}

}  // namespace mapweld::eval
