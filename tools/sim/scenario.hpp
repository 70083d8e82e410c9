// SPDX-License-Identifier: Apache-2.0
// The description of a simulation: a town, a frame, and the vehicles with their routes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tools/sim/local_frame.hpp"
#include "tools/sim/procedural_town.hpp"
#include "tools/sim/survey.hpp"

namespace mapweld::sim {

struct VehiclePlan {
  int id = 0;                       // 1..32767
  std::vector<GeoPoint> waypoints;  // along the streets, at least two
};

// A map, its path resolved: relative paths in the scenario count from its folder; CityJSON when it ends in .json, else
// OpenStreetMap. Or a town that is invented.
using TownSource = std::variant<std::filesystem::path, TownPlan>;

// Real paths instead of routes: the town is invented around them.
struct PathPlan {
  std::filesystem::path folder;
  std::vector<std::string> names;  // of files "NAME.txt", see path_town.hpp; vehicle n drives the n-th
  bool one_frame = false;          // all lie in one frame and meet; else each gets a town of its own
};

struct Scenario {
  std::string name;
  TownSource town;
  GeoPoint origin;  // of the world frame; for an invented town wherever waypoints put it; the middle of a CityJSON one
  std::uint64_t seed = 1;
  double relief_m = 0;  // standard deviation of the ground's height
  double traffic = 0;   // density, see traffic.hpp
  double max_speed_mps = 10;
  double rain_share = 0;              // of the drives
  std::vector<VehiclePlan> vehicles;  // by rising id; empty when there is a survey or paths
  std::optional<SurveyPlan> survey;   // its drives get the ids 1, 2, ...
  std::optional<PathPlan> paths;      // so do these
};

// The ids of its vehicles or of its survey's drives, rising.
std::vector<int> VehicleIds(const Scenario& scenario);

// Throws std::runtime_error naming the file and the key that is missing, unknown or out of range.
Scenario ReadScenario(const std::filesystem::path& file);

// A scenario that comes with the program: "four_drives", "city", ... Throws std::runtime_error listing them.
std::filesystem::path ScenarioByName(const std::string& name);

}  // namespace mapweld::sim
