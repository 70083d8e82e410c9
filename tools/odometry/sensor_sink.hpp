// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/sensor/imu_sample.hpp"
#include "core/sensor/lidar_packet.hpp"

namespace mapweld::odometry {

// Takes what the sensors of one vehicle say, in the order of arrival.
class SensorSink {
 public:
  virtual ~SensorSink() = default;
  virtual void OnImu(const sensor::ImuSample& sample) = 0;
  virtual void OnPacket(const sensor::LidarPacket& packet) = 0;
};

}  // namespace mapweld::odometry
