// SPDX-License-Identifier: Apache-2.0
#include "core/correct/local_correction.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/geom/between_factor.hpp"

namespace mapweld::correct {
namespace {

using geom::Mat6d;
using geom::Pose3;
using geom::Vec6d;

Vec6d Weights(double sigma_m, double sigma_rad) {
  Vec6d w;
  w.head<3>().setConstant(1.0 / (sigma_m * sigma_m));
  w.tail<3>().setConstant(1.0 / (sigma_rad * sigma_rad));
  return w;
}

}  // namespace

void LocalCorrection::AddKeyframe(std::int32_t keyframe, const Pose3& odom_T_body) {
  if (keyframe < 0) return;
  Entry& entry = history_[static_cast<std::size_t>(keyframe) % kHistory];
  entry = Entry{};
  entry.keyframe = keyframe;
  entry.odom_T_body = odom_T_body;
}

LocalCorrection::Entry* LocalCorrection::Find(std::int32_t keyframe) {
  if (keyframe < 0) return nullptr;
  Entry& entry = history_[static_cast<std::size_t>(keyframe) % kHistory];
  return entry.keyframe == keyframe ? &entry : nullptr;
}

Status LocalCorrection::AddMergedPose(const MergedPose& pose) {
  if (!pose.merged_T_body.IsValid() || !(pose.sigma_m > 0) || !(pose.sigma_rad > 0) || pose.group < 0) {
    return Status::kBadInput;
  }
  if (pose.revision < revision_) return Status::kStale;
  Entry* const entry = Find(pose.keyframe);
  if (entry == nullptr) return Status::kOutOfRange;
  if (pose.group != group_) {
    for (Entry& other : history_) other.has_merged = false;
    group_ = pose.group;
    jump_ = true;
  }
  revision_ = pose.revision;
  entry->has_merged = true;
  entry->merged = pose;
  Solve();
  return Status::kOk;
}

// The window is the last correction_window keyframes with a merged pose of the newest revisions. Chain of between
// factors, one robust prior each: the normal matrix is block tridiagonal.
void LocalCorrection::Solve() {
  FixedVector<const Entry*, kHistory> known;
  for (const Entry& entry : history_) {
    if (entry.has_merged) (void)known.TryPush(&entry);
  }
  std::sort(known.begin(), known.end(), [](const Entry* a, const Entry* b) { return a->keyframe < b->keyframe; });
  constexpr std::size_t kWindow = kCap.correction_window;
  const std::size_t n = std::min(known.size(), kWindow);
  const std::size_t first = known.size() - n;

  std::array<Pose3, kWindow> pose;
  for (std::size_t i = 0; i < n; ++i) pose[i] = known[first + i]->merged.merged_T_body;

  std::array<Mat6d, kWindow> diagonal;
  std::array<Mat6d, kWindow> below;  // block (i, i - 1)
  std::array<Vec6d, kWindow> gradient;
  for (int iteration = 0; iteration < config_.iterations; ++iteration) {
    for (std::size_t i = 0; i < n; ++i) {
      const MergedPose& merged = known[first + i]->merged;
      const Vec6d r = geom::LocalCoordinates(merged.merged_T_body, pose[i]);
      Vec6d w = Weights(merged.sigma_m, merged.sigma_rad);
      const double chi = std::sqrt(r.dot(w.cwiseProduct(r)));
      if (chi > config_.robust_sigma) w *= config_.robust_sigma / chi;
      // d LocalCoordinates(m, p) / d p: rotation of p against m for the position, inverse right Jacobian for the angle.
      Mat6d j = Mat6d::Zero();
      j.topLeftCorner<3, 3>() = (merged.merged_T_body.q.conjugate() * pose[i].q).toRotationMatrix();
      j.bottomRightCorner<3, 3>() = geom::RightJacobianInverseSo3(r.tail<3>());
      diagonal[i] = j.transpose() * w.asDiagonal() * j;
      gradient[i] = j.transpose() * w.cwiseProduct(r);
      below[i].setZero();
      if (i == 0) continue;
      const Entry& a = *known[first + i - 1];
      const Entry& b = *known[first + i];
      const double steps = std::max(1, b.keyframe - a.keyframe);
      const Vec6d wo = Weights(config_.odometry_sigma_m, config_.odometry_sigma_rad) / steps;
      const auto f = geom::LinearizeBetween(pose[i - 1], pose[i], a.odom_T_body.Inverse() * b.odom_T_body);
      diagonal[i - 1] += f.jacobian_a.transpose() * wo.asDiagonal() * f.jacobian_a;
      diagonal[i] += f.jacobian_b.transpose() * wo.asDiagonal() * f.jacobian_b;
      below[i] = f.jacobian_b.transpose() * wo.asDiagonal() * f.jacobian_a;
      gradient[i - 1] += f.jacobian_a.transpose() * wo.cwiseProduct(f.residual);
      gradient[i] += f.jacobian_b.transpose() * wo.cwiseProduct(f.residual);
    }
    for (std::size_t i = 1; i < n; ++i) {
      const Mat6d factor = diagonal[i - 1].ldlt().solve(below[i].transpose()).transpose();
      diagonal[i] -= factor * below[i].transpose();
      gradient[i] -= factor * gradient[i - 1];
    }
    Vec6d step = Vec6d::Zero();
    for (std::size_t i = n; i-- > 0;) {
      Vec6d rhs = -gradient[i];
      if (i + 1 < n) rhs -= below[i + 1].transpose() * step;
      step = diagonal[i].ldlt().solve(rhs);
      if (!step.allFinite()) return;
      pose[i] = geom::Retract(pose[i], step);
    }
  }
  target_ = pose[n - 1] * known[first + n - 1]->odom_T_body.Inverse();
}

Pose3 LocalCorrection::MergedFromOdom(TimeNs t) {
  if (!active()) return {};
  if (jump_) {
    published_ = target_;
    jump_ = false;
  } else {
    const double dt = std::clamp((t - last_t_).Seconds(), 0.0, 1.0);
    Vec6d step = geom::LocalCoordinates(published_, target_);
    const auto limit = [](auto part, double most) {
      const double size = part.norm();
      if (size > most) part *= most / size;
    };
    limit(step.head<3>(), config_.slew_m_per_s * dt);
    limit(step.tail<3>(), config_.slew_rad_per_s * dt);
    published_ = geom::Retract(published_, step);
  }
  last_t_ = t;
  return published_;
}

}  // namespace mapweld::correct
