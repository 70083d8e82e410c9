// SPDX-License-Identifier: Apache-2.0
// Routes for a whole fleet: the town is divided into zones far enough apart that no vehicle of one sees another's
// streets, and every vehicle wanders through one zone.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/sim/road_graph.hpp"
#include "tools/sim/route.hpp"

namespace mapweld::sim {

struct SurveyPlan {
  int drives = 0;
  int zones = 1;              // drives are dealt out in turn
  double zone_radius_m = 0;   // of the disc that its drives stay in
  double zone_gap_m = 200;    // between discs, at least
  double min_length_m = 0;    // of a drive
  double max_length_m = 0;    // few drives are that long: the lengths fall off exponentially
  double total_length_m = 0;  // of all drives
  int runs = 1;               // every route is driven that often, the second time backwards, the third forwards, ...
  bool straight_on = false;  // routes go straight on at junctions and share no street with one another: they only cross
};

struct SurveyedDrive {
  int zone = 0;
  StreetPath path;
};

// Drives route * runs, route * runs + 1, ... are the runs of one route. The zones with the most street that can be
// driven without turning back, largest first. Depends on its arguments only. Throws std::runtime_error when the town
// has no room for the zones or a zone no loop to drive.
std::vector<SurveyedDrive> PlanSurvey(const RoadGraph& graph, const SurveyPlan& plan, std::uint64_t seed);

}  // namespace mapweld::sim
