// SPDX-License-Identifier: Apache-2.0
// One vehicle's drive as clouds with poses, in the folder layouts that published data sets use. A cloud is one turn of
// the LiDAR every `scan_spacing_m`, de-skewed, in the frame of the body at the turn's begin.
//   kitti   velodyne/000000.bin, poses.txt (world_T_body, relative to the first), times.txt, calib.txt (identity)
//   mulran  Ouster/<ns>.bin, global_pose.csv (<ns>, twelve numbers of the 3 x 4 pose)
//   gprs    000001.pcd, 000001_pose6d.npy (x y z roll pitch yaw), as the AutoMerge authors' ALITA data: one submap of
//           the last 50 m per 5 m
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "tools/sim/lidar_simulator.hpp"

namespace mapweld::sim {

enum class CloudLayout : std::uint8_t { kKitti, kMulran, kGprs };

struct CloudSpec {
  CloudLayout layout = CloudLayout::kKitti;
  LidarModel lidar;
  Weather weather;
  std::int64_t start_past_hour_ns = 0;
  double duration_s = 0;
  std::uint64_t seed = 0;
  double scan_spacing_m = 1;
};

// Writes into the existing folder `dir`; returns the number of clouds. `progress` gets shares from 0 to 1. Throws
// std::runtime_error when a file cannot be written.
std::int64_t WriteClouds(const RayCaster& caster, const VehicleMotion& motion, const Traffic* traffic,
                         const CloudSpec& spec, const std::filesystem::path& dir,
                         const std::function<void(double)>& progress);

}  // namespace mapweld::sim
