// SPDX-License-Identifier: Apache-2.0
// Finds "down" and the gyro's offset while the vehicle stands still.
#pragma once

#include "core/base/status.hpp"
#include "core/geom/so3.hpp"
#include "core/sensor/imu_sample.hpp"

namespace mapweld::lio {

struct ImuAlignmentConfig {
  double duration_s = 1.0;        // of rest
  double max_gyro_spread = 0.03;  // rad/s, standard deviation per axis: above it the vehicle moves
  double max_accel_spread = 0.4;  // m/s^2
};

struct Alignment {
  geom::Quatd odom_R_body = geom::Quatd::Identity();  // roll and pitch from gravity, yaw 0
  geom::Vec3d gyro_bias = geom::Vec3d::Zero();        // rad/s
  double gravity_m_s2 = 9.81;                         // as this accelerometer measures it
};

// Feed samples in order until Add gives kOk. Motion restarts the average. 60 flops a sample.
class ImuAlignment {
 public:
  explicit ImuAlignment(const ImuAlignmentConfig& config = {}) : config_(config) {}

  // kNotReady: needs more rest. kOutOfRange: at rest, but the specific force is not that of gravity (8.8..10.8 m/s^2).
  Status Add(const sensor::ImuSample& sample);
  // Valid after Add gave kOk.
  [[nodiscard]] const Alignment& alignment() const { return alignment_; }

 private:
  void Restart(const sensor::ImuSample& sample);

  ImuAlignmentConfig config_;
  Alignment alignment_;
  TimeNs begin_;
  int n_ = 0;
  geom::Vec3d gyro_sum_ = geom::Vec3d::Zero();
  geom::Vec3d gyro_sum_sq_ = geom::Vec3d::Zero();
  geom::Vec3d accel_sum_ = geom::Vec3d::Zero();
  geom::Vec3d accel_sum_sq_ = geom::Vec3d::Zero();
};

}  // namespace mapweld::lio
