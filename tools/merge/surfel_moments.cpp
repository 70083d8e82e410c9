// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/surfel_moments.hpp"

#include <Eigen/LU>

namespace mapweld::merge {
namespace {
constexpr double kRounding_m = 0.15;  // standard deviation that voxels and noise add in every direction
constexpr double kLonely_m = 0.3;     // shape of a voxel with too few points around it
constexpr double kMinPoints = 5;
constexpr double kGroundThickness_m = 0.2;  // standard deviation of rough ground across its plane
constexpr double kGroundShare = 0.75;       // of the information that points up, from which on a surface is ground
}  // namespace

void SurfelMoments::Add(const Eigen::Vector3f& point) {
  const Eigen::Vector3d p = point.cast<double>();
  n += 1;
  sum += p;
  xx += p.x() * p.x();
  xy += p.x() * p.y();
  xz += p.x() * p.z();
  yy += p.y() * p.y();
  yz += p.y() * p.z();
  zz += p.z() * p.z();
}

void SurfelMoments::Add(const SurfelMoments& other) {
  n += other.n;
  sum += other.sum;
  xx += other.xx;
  xy += other.xy;
  xz += other.xz;
  yy += other.yy;
  yz += other.yz;
  zz += other.zz;
}

void SurfelMoments::Describe(Surfel* surfel) const {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity() * (kLonely_m * kLonely_m);
  if (n >= kMinPoints) {
    covariance << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    const Eigen::Vector3d mean = sum / n;
    covariance = (covariance / n - mean * mean.transpose()).eval();
  }
  covariance.diagonal().array() += kRounding_m * kRounding_m;
  const Eigen::Matrix3d w = covariance.inverse();
  const double thickness_squared = kGroundThickness_m * kGroundThickness_m + kRounding_m * kRounding_m;
  const bool is_ground = w(2, 2) > kGroundShare * w.trace() && w(2, 2) * thickness_squared > 1;
  surfel->is_structure = n >= kMinPoints && !is_ground;
  surfel->xx = static_cast<float>(w(0, 0));
  surfel->xy = static_cast<float>(w(0, 1));
  surfel->xz = static_cast<float>(w(0, 2));
  surfel->yy = static_cast<float>(w(1, 1));
  surfel->yz = static_cast<float>(w(1, 2));
  surfel->zz = static_cast<float>(w(2, 2));
}

}  // namespace mapweld::merge
