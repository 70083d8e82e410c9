// SPDX-License-Identifier: Apache-2.0
// Plays the files of a drive through the agent's own decoders.
#pragma once

#include <filesystem>

#include "tools/odometry/sensor_sink.hpp"

namespace mapweld::odometry {

// `drive`/lidar.pcap (VLP-16) and `drive`/imu.candump (Xsens MTi), both on one sensor clock. Throws std::runtime_error
// when a file cannot be read; what the decoders refuse is left out, as on the vehicle.
void PlayDrive(const std::filesystem::path& drive, SensorSink* sink);

}  // namespace mapweld::odometry
