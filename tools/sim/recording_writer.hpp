// SPDX-License-Identifier: Apache-2.0
// One vehicle's drive as files: what its sensors would have sent, and the truth.
//   lidar.pcap    data packets of a VLP-16, HDL-32E or OS1, stamped when the last beam has fired
//   lidar_metadata.json   of an OS1: what the agent's --lidar-calibration wants
//   imu.candump   MTi-600 frames at 200 Hz, stamped when they leave the bus (0.4 ms per frame at 250 kbit/s)
//   truth.tum     t x y z qx qy qz qw: world_T_body, 20 per second
// All stamps are one sensor time, seconds past the hour.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "tools/sim/imu_noise.hpp"
#include "tools/sim/lidar_simulator.hpp"

namespace mapweld::sim {

struct DriveSpec {
  std::int64_t start_past_hour_ns = 0;
  double duration_s = 0;  // not beyond the motion's own duration
  std::uint64_t seed = 0;
  LidarModel lidar = LidarByName("vlp16");  // one with PacketColumns
  bool dual_return = false;
  Weather weather;
  ImuModel imu;
};

struct DriveCounts {
  std::int64_t packets = 0;
  std::int64_t rays = 0;
  std::int64_t returns = 0;
  std::int64_t imu_samples = 0;
};

// Columns in a packet of this LiDAR; 0 when its packets are not written.
std::int64_t PacketColumns(const LidarModel& model, bool dual);
// What one beam of one column takes in the capture file, headers shared out.
double PacketBytesPerBeam(const LidarModel& model);

// Writes into the existing folder `dir`. `progress` gets shares from 0 to 1. Throws std::runtime_error when a file
// cannot be written.
DriveCounts WriteRecording(const RayCaster& caster, const VehicleMotion& motion, const Traffic* traffic,
                           const DriveSpec& spec, const std::filesystem::path& dir,
                           const std::function<void(double)>& progress);

}  // namespace mapweld::sim
