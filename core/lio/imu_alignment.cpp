// SPDX-License-Identifier: Apache-2.0
#include "core/lio/imu_alignment.hpp"

#include <cmath>

namespace mapweld::lio {
namespace {

double Spread(const geom::Vec3d& sum, const geom::Vec3d& sum_sq, int n) {
  const geom::Vec3d mean = sum / n;
  const geom::Vec3d variance = sum_sq / n - mean.cwiseProduct(mean);
  return std::sqrt(std::fmax(variance.maxCoeff(), 0.0));
}

}  // namespace

void ImuAlignment::Restart(const sensor::ImuSample& sample) {
  begin_ = sample.t;
  n_ = 0;
  gyro_sum_.setZero();
  gyro_sum_sq_.setZero();
  accel_sum_.setZero();
  accel_sum_sq_.setZero();
}

Status ImuAlignment::Add(const sensor::ImuSample& sample) {
  if (all_ == 0 || sample.t < first_) {
    first_ = sample.t;
    all_ = 0;
    accel_sum_all_.setZero();
  }
  if (n_ == 0 || sample.t < begin_) Restart(sample);
  ++all_;
  accel_sum_all_ += sample.accel_body;
  ++n_;
  gyro_sum_ += sample.gyro_body;
  gyro_sum_sq_ += sample.gyro_body.cwiseProduct(sample.gyro_body);
  accel_sum_ += sample.accel_body;
  accel_sum_sq_ += sample.accel_body.cwiseProduct(sample.accel_body);

  const bool moving = n_ >= 20 && (Spread(gyro_sum_, gyro_sum_sq_, n_) > config_.max_gyro_spread ||
                                   Spread(accel_sum_, accel_sum_sq_, n_) > config_.max_accel_spread);
  if (moving || sample.clipped) Restart(sample);
  if ((sample.t - begin_).Seconds() >= config_.duration_s && n_ >= 20) {
    return Finish(accel_sum_ / n_, gyro_sum_ / n_, false);
  }
  if (moving && (sample.t - first_).Seconds() >= config_.patience_s) {
    return Finish(accel_sum_all_ / all_, geom::Vec3d::Zero(), true);
  }
  return Status::kNotReady;
}

Status ImuAlignment::Finish(const geom::Vec3d& mean_accel, const geom::Vec3d& gyro_bias, bool moving) {
  n_ = 0;
  all_ = 0;
  alignment_.gravity_m_s2 = mean_accel.norm();
  const bool upright_enough = mean_accel.z() > 0.7 * alignment_.gravity_m_s2;
  if (alignment_.gravity_m_s2 < 8.8 || alignment_.gravity_m_s2 > 10.8 || !upright_enough) return Status::kOutOfRange;
  alignment_.moving = moving;
  alignment_.gyro_bias = gyro_bias;
  // The smallest rotation that puts the measured force upright has some yaw in it; local starts with yaw 0.
  const geom::Quatd upright = geom::RotationBetween(mean_accel.normalized(), geom::Vec3d::UnitZ());
  const geom::Quatd unyaw(Eigen::AngleAxisd(-geom::Yaw(upright), geom::Vec3d::UnitZ()));
  alignment_.local_R_body = (unyaw * upright).normalized();
  return Status::kOk;
}

}  // namespace mapweld::lio
