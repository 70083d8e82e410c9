// SPDX-License-Identifier: Apache-2.0
// A drive along an endless street of boxes, as IMU samples and LiDAR packets with known truth. No files, no
// dependencies, no heap while stepping: for tests of the agent's modules.
#pragma once

#include <array>
#include <cstdint>

#include "core/pipeline/agent_pipeline.hpp"

namespace mapweld::test {

enum class Surroundings {
  kStreet,       // houses and poles
  kCorridor,     // endless smooth walls: nothing fixes the position along them
  kTunnel,       // the same with a ceiling
  kCountryRoad,  // a block of a metre every 14 m on either side: little fixes the position
  kOpenField,    // nothing but the ground: nothing fixes position in the plane and heading
};

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
  Surroundings surroundings = Surroundings::kStreet;
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
  void BuildAround(float x);
  void FindNearBoxes(const Eigen::Vector3f& from, double heading_rad, double half_width_rad);
  [[nodiscard]] float Cast(const Eigen::Vector3f& from, const Eigen::Vector3f& direction) const;
  double Noise();

  StreetDriveConfig config_;
  FixedVector<Box, 64> boxes_;
  std::int64_t built_around_ = 0;    // this block
  FixedVector<Box, 64> near_boxes_;  // that the present packet may meet
  std::uint64_t noise_state_ = 1;
  std::int64_t packet_ = 0;
  std::int64_t imu_ = 0;
  sensor::LidarPacket scratch_packet_;
  FixedVector<sensor::ImuSample, 16> scratch_samples_;
};

}  // namespace mapweld::test
