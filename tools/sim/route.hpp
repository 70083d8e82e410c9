// SPDX-License-Identifier: Apache-2.0
// From waypoints to a line along the streets.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/sim/local_frame.hpp"
#include "tools/sim/road_graph.hpp"

namespace mapweld::sim {

struct StreetPath {
  std::vector<std::uint32_t> nodes;  // of the road graph, in driving order
  Polyline centreline;               // their positions
};

// Shortest way along the streets through all waypoints. `who` names the vehicle in error messages. Throws
// std::runtime_error for fewer than two waypoints, one outside `bounds` or farther than 40 m from any street, streets
// that are not connected, and a route that turns back on itself.
StreetPath PlanStreetPath(const RoadGraph& graph, const Box2& bounds, const LocalFrame& frame,
                          const std::vector<GeoPoint>& waypoints, const std::string& who);

struct SharedStreet {
  double same_direction_m = 0;
  double opposite_direction_m = 0;
};
// How much street two routes of one graph have in common.
SharedStreet FindSharedStreet(const StreetPath& a, const StreetPath& b);

}  // namespace mapweld::sim
