// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/sim_world.hpp"

#include <fmt/format.h>

namespace mapweld::sim {
namespace {

std::vector<SurveyedDrive> PlanRoutes(const Scenario& scenario, const Town& town, const LocalFrame& frame,
                                      std::uint64_t seed) {
  const RoadGraph graph(town.roads);
  if (scenario.survey) return PlanSurvey(graph, *scenario.survey, seed);
  std::vector<SurveyedDrive> routes;
  for (const VehiclePlan& plan : scenario.vehicles) {
    routes.push_back(
        {0, PlanStreetPath(graph, town.bounds, frame, plan.waypoints, fmt::format("route of vehicle {}", plan.id))});
  }
  return routes;
}

Box2 AreaAround(const std::vector<SurveyedDrive>& routes) {
  constexpr double kSight_m = 160;  // beyond the range of the sensor, so that no house at its edge is cut
  Box2 area;
  for (const SurveyedDrive& route : routes) {
    for (const Vec2d& p : route.path.centreline) area.Extend(p);
  }
  return area.Grown(kSight_m);
}

}  // namespace

SimWorld::SimWorld(const Scenario& scenario, std::uint64_t seed)
    : frame_(scenario.origin),
      town_(ReadOsmTown(scenario.town, frame_)),
      routes_(PlanRoutes(scenario, town_, frame_, seed)),
      mesh_(BuildTownMesh(town_, AreaAround(routes_))),
      caster_(mesh_) {}

}  // namespace mapweld::sim
