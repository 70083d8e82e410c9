// SPDX-License-Identifier: Apache-2.0
// Finds "down" and the gyro's offset while the vehicle stands still; when it never does, "down" as well as the mean of
// some seconds of driving tells.
#pragma once

#include "core/base/status.hpp"
#include "core/geom/so3.hpp"
#include "core/sensor/imu_sample.hpp"

namespace mapweld::lio {

struct ImuAlignmentConfig {
  double duration_s = 1.0;  // of rest
  // Standard deviations per axis of means over `smoothing_s`: above them the vehicle moves. An idling engine shakes it
  // at more than 10 Hz, driving does so more slowly.
  double max_gyro_spread = 0.03;  // rad/s
  double max_accel_spread = 0.4;  // m/s^2
  double smoothing_s = 0.1;
  double patience_s = 5.0;  // without rest: then the start is in motion
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
  void CloseMean(const sensor::ImuSample& sample);
  Status Finish(const geom::Vec3d& mean_accel, const geom::Vec3d& gyro_bias, bool moving);

  ImuAlignmentConfig config_;
  Alignment alignment_;
  TimeNs first_;  // sample since the start or the last refusal
  int all_ = 0;
  geom::Vec3d accel_sum_all_ = geom::Vec3d::Zero();
  TimeNs begin_;  // of what looks like rest so far
  struct Sums {
    int n = 0;
    geom::Vec3d gyro = geom::Vec3d::Zero();
    geom::Vec3d accel = geom::Vec3d::Zero();
    void Add(const geom::Vec3d& of_gyro, const geom::Vec3d& of_accel);
  };
  Sums rest_;  // samples
  TimeNs mean_begin_;
  Sums mean_;     // samples of the mean under way
  Sums means_;    // means over smoothing_s
  Sums squares_;  // their squares
};

}  // namespace mapweld::lio
