// SPDX-License-Identifier: Apache-2.0
// Runs a scenario: from its description to a folder of recordings.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/sim/recording_writer.hpp"

namespace mapweld::sim {

struct SimOptions {
  std::filesystem::path scenario;
  std::filesystem::path out;
  std::vector<int> vehicles;          // empty: all
  std::optional<std::uint64_t> seed;  // else the scenario's
  std::optional<double> seconds;      // no drive longer than this
  unsigned threads = 0;               // 0: one per processor
};

struct VehicleSummary {
  int id = 0;
  double length_m = 0;    // of the part that was driven
  double duration_s = 0;  // of sensor time
  DriveCounts counts;
};

struct SimSummary {
  std::vector<VehicleSummary> vehicles;
  double prepare_s = 0;  // town, routes, scene
  double drive_s = 0;    // all recordings, wall clock
};

// Vehicle n starts 600 + n seconds past the hour. Writes `out`/vehicle_<n>/ and `out`/scenario.json beside `out` first
// and moves them into place at the end; an earlier recording at `out` is replaced, anything else there is refused.
// `progress(vehicle, share)` is called by several threads. Throws std::runtime_error.
SimSummary Simulate(const SimOptions& options, const std::function<void(int, double)>& progress);

}  // namespace mapweld::sim
