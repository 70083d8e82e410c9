// SPDX-License-Identifier: Apache-2.0
// The description of a simulation: a town, a frame, and the vehicles with their routes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/sim/local_frame.hpp"
#include "tools/sim/survey.hpp"

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
  std::vector<VehiclePlan> vehicles;  // by rising id; empty when there is a survey
  std::optional<SurveyPlan> survey;   // its drives get the ids 1, 2, ...
};

// Throws std::runtime_error naming the file and the key that is missing, unknown or out of range.
Scenario ReadScenario(const std::filesystem::path& file);

// A scenario that comes with the program: "four_drives", "city", ... Throws std::runtime_error listing them.
std::filesystem::path ScenarioByName(const std::string& name);

}  // namespace mapweld::sim
