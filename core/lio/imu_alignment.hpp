// SPDX-License-Identifier: Apache-2.0
// Finds "down" and the gyro's offset while the vehicle stands still; when it never does, "down" as well as the mean of
// some seconds of driving tells.
#pragma once

#include "core/base/status.hpp"
#include "core/geom/so3.hpp"
#include "core/sensor/imu_sample.hpp"

namespace mapweld::lio {

struct ImuAlignmentConfig {
  double duration_s = 1.0;        // of rest
  double max_gyro_spread = 0.03;  // rad/s, standard deviation per axis: above it the vehicle moves
  double max_accel_spread = 0.4;  // m/s^2
  double patience_s = 5.0;        // without rest: then the start is in motion
};

struct Alignment {
  geom::Quatd local_R_body = geom::Quatd::Identity();  // roll and pitch from gravity, yaw 0
  geom::Vec3d gyro_bias = geom::Vec3d::Zero();         // rad/s
  double gravity_m_s2 = 9.81;                          // as this accelerometer measures it
  bool moving = false;  // the vehicle never stood still: roll and pitch may be wrong by 5 degrees, the bias is unknown
};

// Feed samples in order until Add gives kOk. Motion restarts the average at rest. 60 flops a sample.
class ImuAlignment {
 public:
  explicit ImuAlignment(const ImuAlignmentConfig& config = {}) : config_(config) {}

  // kNotReady: needs more rest. kOutOfRange: the mean specific force is not that of gravity (8.8..10.8 m/s^2), or it
  // points more than 45 degrees away from the body's z axis: a wrong unit, sign or axis.
  Status Add(const sensor::ImuSample& sample);
  // Valid after Add gave kOk.
  [[nodiscard]] const Alignment& alignment() const { return alignment_; }

 private:
  void Restart(const sensor::ImuSample& sample);
  Status Finish(const geom::Vec3d& mean_accel, const geom::Vec3d& gyro_bias, bool moving);

  ImuAlignmentConfig config_;
  Alignment alignment_;
  TimeNs first_;  // sample since the start or the last refusal
  int all_ = 0;
  geom::Vec3d accel_sum_all_ = geom::Vec3d::Zero();
  TimeNs begin_;  // of what looks like rest so far
  int n_ = 0;
  geom::Vec3d gyro_sum_ = geom::Vec3d::Zero();
  geom::Vec3d gyro_sum_sq_ = geom::Vec3d::Zero();
  geom::Vec3d accel_sum_ = geom::Vec3d::Zero();
  geom::Vec3d accel_sum_sq_ = geom::Vec3d::Zero();
};

}  // namespace mapweld::lio
