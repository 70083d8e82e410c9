// SPDX-License-Identifier: Apache-2.0
#include "core/lio/scan_match.hpp"

#include <algorithm>
#include <cmath>

namespace mapweld::lio {

void FeaturePlanes::Find(const scan::FeaturePoints& features, const geom::Pose3& odom_T_body, VoxelMap* map) {
  const Eigen::Matrix3f rotation = odom_T_body.q.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = odom_T_body.t.cast<float>();
  found_at_ = odom_T_body;
  planes_.resize(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (!map->FindPlane(rotation * features[i].p + translation, &planes_[i])) planes_[i].variance = -1;
  }
}

bool FeaturePlanes::HoldAt(const geom::Pose3& odom_T_body) const {
  constexpr double kShift_m = 0.05;
  constexpr double kTurn_rad = 0.05 / 25;
  return (odom_T_body.t - found_at_.t).norm() < kShift_m && odom_T_body.q.angularDistance(found_at_.q) < kTurn_rad;
}

ScanMatch MatchScan(const scan::FeaturePoints& features, const FeaturePlanes& planes, const geom::Pose3& odom_T_body,
                    double gate_m, const ScanMatchConfig& config) {
  const Eigen::Matrix3f rotation = odom_T_body.q.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = odom_T_body.t.cast<float>();
  ScanMatch match;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Plane& plane = planes.planes()[i];
    if (plane.variance < 0) continue;
    const scan::BodyPoint& feature = features[i];
    const Eigen::Vector3f p_odom = rotation * feature.p + translation;
    ++match.matched;
    const double residual = static_cast<double>(plane.normal.dot(p_odom - plane.mean));
    const double variance = config.range_sigma_m * config.range_sigma_m + static_cast<double>(plane.variance);
    const double sigma = std::sqrt(variance);
    const double gate = std::max({gate_m, config.gate_sigma * sigma, config.min_gate_m});
    if (std::abs(residual) > gate) continue;
    ++match.inliers;
    match.residual_sq_sum += residual * residual;

    // d(R p)/d rotation = -R [p]x, so its row against n is (p x R'n)'.
    const Eigen::Vector3f normal_body = rotation.transpose() * plane.normal;
    geom::Vec6d row;
    row.head<3>() = plane.normal.cast<double>();
    row.tail<3>() = feature.p.cross(normal_body).cast<double>();
    const double huber = std::abs(residual) <= 1.5 * sigma ? 1.0 : 1.5 * sigma / std::abs(residual);
    const double weight = huber / (variance * config.correlation);
    match.information.noalias() += (weight * row) * row.transpose();
    match.gradient.noalias() += (weight * residual) * row;
    const double leaning = weight * config.correlation * static_cast<double>(plane.tilt_variance);
    const geom::Vec3d p = feature.p.cast<double>();
    match.normal_noise.position += leaning;
    match.normal_noise.rotation += leaning * (p.squaredNorm() * geom::Mat3d::Identity() - p * p.transpose());
  }
  return match;
}

}  // namespace mapweld::lio
