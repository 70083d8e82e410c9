// SPDX-License-Identifier: Apache-2.0
// Spoils the data of good sensors on purpose, to see what the odometry makes of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/odometry/sensor_sink.hpp"

namespace mapweld::odometry {

enum class FaultKind {
  kImuGap,      // amount: seconds without samples
  kImuStuck,    // seconds of one repeated value
  kImuClipped,  // seconds of samples marked as clipped
  kImuBias,     // rad/s that the gyro's x axis is off from then on
  kImuLate,     // milliseconds by which the stamps of the IMU are behind
  kLidarGap,    // seconds without packets
  kPacketLoss,  // percent of the packets, at random
  kTilted,      // degrees by which the LiDAR is turned about y against its calibration
  kShifted,     // centimetres by which it is moved forward
  kTraffic,     // percent, about, of the points on trucks in both neighbouring lanes
};

struct Fault {
  FaultKind kind;
  double amount;
  double from_s;  // after the first sample
};

// "imu-gap:1:40" is a gap of 1 s after 40 s; without the second number the fault begins at the start. Throws
// std::runtime_error with the list of names.
Fault ParseFault(const std::string& text);

// Passes everything on to `sink`, spoiled.
std::unique_ptr<SensorSink> MakeFaults(const std::vector<Fault>& faults, SensorSink* sink);

}  // namespace mapweld::odometry
