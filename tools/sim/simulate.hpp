// SPDX-License-Identifier: Apache-2.0
// Runs a scenario: from its description to a folder of recordings.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/sim/agent_log.hpp"
#include "tools/sim/recording_writer.hpp"

namespace mapweld::sim {

// What is written of every drive.
enum class Layout : std::uint8_t {
  kWire,     // every packet and CAN frame: vehicle_<n>/, see recording_writer.hpp
  kSubmaps,  // what the agent would have published: agent_<n>.lcm and truth/agent_<n>.tum, see agent_log.hpp
  kKitti,    // clouds and true poses: vehicle_<n>/, see cloud_writer.hpp; the other two likewise
  kMulran,
  kGprs,
};

struct SimOptions {
  std::filesystem::path scenario;
  std::filesystem::path out;
  Layout layout = Layout::kWire;
  std::string lidar = "vlp16";        // see lidar_model.hpp
  bool dual_return = false;           // of the packets, layout kWire
  double vibration_mps2 = 0;          // of the IMU, layout kWire; see imu_noise.hpp
  std::vector<int> vehicles;          // empty: all
  std::optional<std::uint64_t> seed;  // else the scenario's
  std::optional<double> seconds;      // no drive longer than this
  unsigned threads = 0;               // 0: one per processor
};

struct VehicleSummary {
  int id = 0;
  double length_m = 0;    // of the part that was driven
  double duration_s = 0;  // of sensor time
  DriveCounts counts;     // layout kWire
  AgentLogCounts log;     // layout kSubmaps
  std::int64_t clouds = 0;
};

struct SimSummary {
  std::vector<VehicleSummary> vehicles;
  int overlaps = 0;      // pairs of vehicles that share a stretch of street, see kMinOverlap_m
  double prepare_s = 0;  // town, routes, scene
  double drive_s = 0;    // all recordings, wall clock
};

inline constexpr double kMinOverlap_m = 30;  // driven together, to be listed as an overlap; less is a crossing

// Vehicle n starts 600 + n seconds past the hour. Writes the drives and `out`/scenario.json, which lists the true
// overlaps, beside `out` first and moves them into place at the end; an earlier recording at `out` is replaced,
// anything else there is refused. `progress(vehicle, share)` is called by several threads. Throws std::runtime_error.
SimSummary Simulate(const SimOptions& options, const std::function<void(int, double)>& progress);

}  // namespace mapweld::sim
