// SPDX-License-Identifier: Apache-2.0
// One vehicle's drive as its agent would have published it, without driving every revolution: an LCM log with every
// keyframe_t and every piece of its submap, stamped with sensor time, made of true scans every few metres laid out
// along a drifting odometry. `lcm-logplayer` plays it, `mapweld merge` reads it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "tools/sim/lidar_simulator.hpp"
#include "tools/sim/odometry_drift.hpp"

namespace mapweld::sim {

struct AgentLogSpec {
  std::int16_t agent_id = 1;
  std::int64_t start_past_hour_ns = 0;
  double duration_s = 0;
  std::uint64_t seed = 0;
  LidarModel lidar = LidarByName("vlp16");
  Weather weather;
  OdometryModel odometry;
  double scan_spacing_m = 1.5;  // a real agent has a scan every metre at 36 km/h
};

struct AgentLogCounts {
  std::int64_t scans = 0;
  std::int64_t keyframes = 0;
  std::int64_t submap_bytes = 0;
};

// Writes `log` (LCM) and `truth` (TUM: world_T_body at every scan). `progress` gets shares from 0 to 1. Throws
// std::runtime_error when a file cannot be written. Memory: about 12 MB.
AgentLogCounts WriteAgentLog(const RayCaster& caster, const VehicleMotion& motion, const Traffic* traffic,
                             const AgentLogSpec& spec, const std::filesystem::path& log,
                             const std::filesystem::path& truth, const std::function<void(double)>& progress);

}  // namespace mapweld::sim
