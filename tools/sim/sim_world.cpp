// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/sim_world.hpp"

#include <fmt/format.h>

#include <numbers>

#include "tools/sim/cityjson_town.hpp"
#include "tools/sim/hash_noise.hpp"
#include "tools/sim/osm_town.hpp"
#include "tools/sim/parked_cars.hpp"

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

Town MakeTown(const TownSource& source, const LocalFrame& frame) {
  if (const auto* plan = std::get_if<TownPlan>(&source)) return InventTown(*plan);
  const auto& file = std::get<std::filesystem::path>(source);
  return file.extension() == ".json" ? ReadCityJsonTown(file) : ReadOsmTown(file, frame);
}

Sight SightOfAll(const std::vector<SurveyedDrive>& routes, double reach_m = Sight::kReach_m) {
  std::vector<const Polyline*> lines;
  for (const SurveyedDrive& route : routes) lines.push_back(&route.path.centreline);
  return Sight(lines, reach_m);
}

// Town and routes; the two hang together where real paths are driven.
PathTown Plan(const Scenario& scenario, const LocalFrame& frame, std::uint64_t seed) {
  if (scenario.paths) return BuildPathTown(*scenario.paths, seed);
  PathTown plan;
  plan.town = MakeTown(scenario.town, frame);
  plan.drives = PlanRoutes(scenario, plan.town, frame, seed);
  return plan;
}

}  // namespace

SimWorld::SimWorld(const Scenario& scenario, std::uint64_t seed)
    : SimWorld(scenario, seed, Plan(scenario, LocalFrame(scenario.origin), seed)) {}

SimWorld::SimWorld(const Scenario& scenario, std::uint64_t seed, PathTown plan)
    : frame_(scenario.origin),
      max_speed_mps_(scenario.max_speed_mps),
      traffic_(scenario.traffic),
      rain_share_(scenario.rain_share),
      town_(std::move(plan.town)),
      relief_(scenario.relief_m, Hash(seed, 0x4155), town_.cellar),
      real_paths_(scenario.paths.has_value()),
      routes_(std::move(plan.drives)),
      clearance_(town_, SightOfAll(routes_)),
      mesh_(BuildTownMesh(town_, SightOfAll(routes_), SightOfAll(routes_, kDetailedWithin_m))) {
  relief_.Lift(&mesh_);
  scene_ = std::make_shared<RayScene>(mesh_);
  for (const int id : VehicleIds(scenario)) drive_seeds_.push_back(Hash(seed, static_cast<std::uint64_t>(id)));
}

LanePath SimWorld::PlanLane(std::size_t vehicle) const {
  const std::uint64_t seed = Hash(drive_seeds_[vehicle], 0x1A4E);
  LaneHabit habit;
  if (real_paths_) return LanePath::Beside(routes_[vehicle].path.centreline, {.offset_m = 0});
  habit.offset_m = Uniform(Hash(seed, 1), 1.35, 1.75);
  habit.wander_m = Uniform(Hash(seed, 2), 0, 0.2);
  habit.wave_m = Uniform(Hash(seed, 3), 60, 180);
  habit.phase_rad = Uniform(Hash(seed, 4), 0, 2 * std::numbers::pi);
  return LanePath::Beside(routes_[vehicle].path.centreline, habit);
}

Weather SimWorld::WeatherOf(std::size_t vehicle) const {
  const std::uint64_t seed = Hash(drive_seeds_[vehicle], 0x4A14);
  Weather weather;
  if (Uniform(Hash(seed, 1)) < rain_share_) weather.rain_mm_per_h = Uniform(Hash(seed, 2), 1, 20);
  return weather;
}

TownMesh SimWorld::OnlyInDrive(std::size_t vehicle) const {
  TownMesh mesh;
  const Sight sight({&routes_[vehicle].path.centreline});
  AddParkedCars(PlotsAlongStreets(town_, sight), clearance_, drive_seeds_[vehicle], mesh);
  relief_.Lift(&mesh);
  return mesh;
}

RayCaster SimWorld::CasterOf(std::size_t vehicle) const {
  const std::uint64_t seed = Hash(drive_seeds_[vehicle], 0xF011);
  return RayCaster({scene_, std::make_shared<RayScene>(OnlyInDrive(vehicle))}, {seed, Uniform(Hash(seed, 1), 0.4, 1)});
}

}  // namespace mapweld::sim
