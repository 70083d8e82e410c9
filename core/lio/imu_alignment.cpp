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

void ImuAlignment::Sums::Add(const geom::Vec3d& of_gyro, const geom::Vec3d& of_accel) {
  ++n;
  gyro += of_gyro;
  accel += of_accel;
}

void ImuAlignment::Restart(const sensor::ImuSample& sample) {
  begin_ = sample.t;
  mean_begin_ = sample.t;
  rest_ = mean_ = means_ = squares_ = {};
}

void ImuAlignment::CloseMean(const sensor::ImuSample& sample) {
  const geom::Vec3d gyro = mean_.gyro / mean_.n;
  const geom::Vec3d accel = mean_.accel / mean_.n;
  means_.Add(gyro, accel);
  squares_.Add(gyro.cwiseAbs2(), accel.cwiseAbs2());
  mean_ = {};
  mean_begin_ = sample.t;
}

Status ImuAlignment::Add(const sensor::ImuSample& sample) {
  if (all_ == 0 || sample.t < first_) {
    first_ = sample.t;
    all_ = 0;
    accel_sum_all_.setZero();
  }
  if (rest_.n == 0 || sample.t < begin_) Restart(sample);
  ++all_;
  accel_sum_all_ += sample.accel_body;
  rest_.Add(sample.gyro_body, sample.accel_body);
  mean_.Add(sample.gyro_body, sample.accel_body);
  if ((sample.t - mean_begin_).Seconds() >= config_.smoothing_s) CloseMean(sample);

  const bool moving = means_.n >= 2 && (Spread(means_.gyro, squares_.gyro, means_.n) > config_.max_gyro_spread ||
                                        Spread(means_.accel, squares_.accel, means_.n) > config_.max_accel_spread);
  if (moving || sample.clipped) Restart(sample);
  if ((sample.t - begin_).Seconds() >= config_.duration_s && rest_.n >= 20) {
    return Finish(rest_.accel / rest_.n, rest_.gyro / rest_.n, false);
  }
  if (moving && (sample.t - first_).Seconds() >= config_.patience_s) {
    return Finish(accel_sum_all_ / all_, geom::Vec3d::Zero(), true);
  }
  return Status::kNotReady;
}

Status ImuAlignment::Finish(const geom::Vec3d& mean_accel, const geom::Vec3d& gyro_bias, bool moving) {
  rest_ = {};
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
