// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/sim_world.hpp"

#include <fmt/format.h>

namespace mapweld::sim {
namespace {

std::vector<StreetPath> PlanRoutes(const Scenario& scenario, const Town& town, const LocalFrame& frame) {
  const RoadGraph graph(town.roads);
  std::vector<StreetPath> routes;
  for (const VehiclePlan& plan : scenario.vehicles) {
    routes.push_back(
        PlanStreetPath(graph, town.bounds, frame, plan.waypoints, fmt::format("route of vehicle {}", plan.id)));
  }
  return routes;
}

Box2 AreaAround(const std::vector<StreetPath>& routes) {
  constexpr double kSight_m = 160;  // beyond the range of the sensor, so that no house at its edge is cut
  Box2 area;
  for (const StreetPath& route : routes) {
    for (const Vec2d& p : route.centreline) area.Extend(p);
  }
  return area.Grown(kSight_m);
}

}  // namespace

SimWorld::SimWorld(const Scenario& scenario)
    : frame_(scenario.origin),
      town_(ReadOsmTown(scenario.town, frame_)),
      routes_(PlanRoutes(scenario, town_, frame_)),
      mesh_(BuildTownMesh(town_, AreaAround(routes_))),
      caster_(mesh_) {}

}  // namespace mapweld::sim
