// SPDX-License-Identifier: Apache-2.0
// The description of a simulation: a town, a frame, and the vehicles with their routes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/sim/local_frame.hpp"

namespace mapweld::sim {

struct VehiclePlan {
  int id = 0;                       // 1..32767
  std::vector<GeoPoint> waypoints;  // along the streets, at least two
};

struct Scenario {
  std::string name;
  std::filesystem::path town;  // resolved: relative paths in the file count from the file's folder
  GeoPoint origin;             // of the world frame
  std::uint64_t seed = 1;
  std::vector<VehiclePlan> vehicles;  // by rising id
};

// Throws std::runtime_error naming the file and the key that is missing, unknown or out of range.
Scenario ReadScenario(const std::filesystem::path& file);

// The demo's four drives, which come with the program.
std::filesystem::path DemoScenario();

}  // namespace mapweld::sim
