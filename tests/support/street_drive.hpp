// SPDX-License-Identifier: Apache-2.0
// A short drive along a street of boxes, as IMU samples and LiDAR packets with known truth. No files, no dependencies,
// no heap while stepping: for tests of the agent's modules.
#pragma once

#include <array>
#include <cstdint>

#include "core/pipeline/agent_pipeline.hpp"

namespace mapweld::test {

struct StreetDriveConfig {
  double seconds = 30;
  double rest_s = 2;  // standing still at the start
  double speed_m_s = 8;
  double weave_m = 1.5;  // lateral amplitude
  double range_noise_m = 0.02;
  double imu_hz = 200;
  double accel_bias_z = 0.05;  // m/s^2
  double accel_bias_y = 0;     // taken for a tilt at the start
  double gyro_bias_z = 0.002;  // rad/s
  bool corridor = false;       // endless smooth walls: nothing fixes the position along the street
  double imu_gap_from_s = -1;  // no IMU samples in this interval
  double imu_gap_to_s = -1;
};

class StreetDrive {
 public:
  explicit StreetDrive(const StreetDriveConfig& config = {});

  // The next packet and the IMU samples before it go to `agent`. False when the drive is over.
  bool Step(pipeline::AgentPipeline* agent);
  // The same into the caller's hands: true when a packet was made; `samples` before it.
  bool Next(sensor::LidarPacket* packet, FixedVector<sensor::ImuSample, 16>* samples);

  // Start of the drive is the origin, heading included.
  [[nodiscard]] geom::Pose3 TruthAt(TimeNs t) const;
  [[nodiscard]] double PathAt(TimeNs t) const;

 private:
  struct Box {
    Eigen::Vector3f low;
    Eigen::Vector3f high;
  };
  [[nodiscard]] geom::Pose3 World(double t_s) const;
  [[nodiscard]] sensor::ImuSample Imu(double t_s);
  void FindNearBoxes(float x);
  [[nodiscard]] float Cast(const Eigen::Vector3f& from, const Eigen::Vector3f& direction) const;
  double Noise();

  StreetDriveConfig config_;
  FixedVector<Box, 512> boxes_;
  FixedVector<Box, 512> near_boxes_;  // within reach of the present packet
  std::uint64_t noise_state_ = 1;
  std::int64_t packet_ = 0;
  std::int64_t imu_ = 0;
  sensor::LidarPacket scratch_packet_;
  FixedVector<sensor::ImuSample, 16> scratch_samples_;
};

}  // namespace mapweld::test
