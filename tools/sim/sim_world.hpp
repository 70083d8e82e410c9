// SPDX-License-Identifier: Apache-2.0
// A scenario made ready to drive: town, streets, routes and what the rays meet.
#pragma once

#include <memory>
#include <vector>

#include "tools/sim/clearance.hpp"
#include "tools/sim/lane_path.hpp"
#include "tools/sim/path_town.hpp"
#include "tools/sim/ray_caster.hpp"
#include "tools/sim/receiver.hpp"
#include "tools/sim/relief.hpp"
#include "tools/sim/route.hpp"
#include "tools/sim/scenario.hpp"

namespace mapweld::sim {

class SimWorld {
 public:
  // Plans the routes of all vehicles and builds the town around all of them, whichever will be simulated later, so that
  // a vehicle sees the same town alone and in company. `seed` chooses the routes of a survey, and with
  // a vehicle's id all that is different in its drive: where in its lane it drives, parked cars, foliage. Throws
  // std::runtime_error, see ReadOsmTown, PlanStreetPath and PlanSurvey.
  SimWorld(const Scenario& scenario, std::uint64_t seed);

  [[nodiscard]] const LocalFrame& frame() const { return frame_; }
  [[nodiscard]] const Town& town() const { return town_; }
  // In the order of the scenario.
  [[nodiscard]] const StreetPath& route(std::size_t vehicle) const { return routes_[vehicle].path; }
  // Vehicles of different zones share no street.
  [[nodiscard]] int zone(std::size_t vehicle) const { return routes_[vehicle].zone; }
  [[nodiscard]] std::size_t vehicles() const { return routes_.size(); }
  // Seed of everything random in one drive.
  [[nodiscard]] std::uint64_t drive_seed(std::size_t vehicle) const { return drive_seeds_[vehicle]; }
  [[nodiscard]] double max_speed_mps() const { return max_speed_mps_; }
  [[nodiscard]] double traffic() const { return traffic_; }  // density, see traffic.hpp
  // Rain in the scenario's share of the drives.
  [[nodiscard]] Weather WeatherOf(std::size_t vehicle) const;
  [[nodiscard]] const Relief& relief() const { return relief_; }
  [[nodiscard]] LanePath PlanLane(std::size_t vehicle) const;
  // What is the same in all drives, and what is there in one only.
  [[nodiscard]] const TownMesh& mesh() const { return mesh_; }
  [[nodiscard]] TownMesh OnlyInDrive(std::size_t vehicle) const;
  // Both together. Builds a small search tree: a few hundredths of a second.
  [[nodiscard]] RayCaster CasterOf(std::size_t vehicle) const;

 private:
  SimWorld(const Scenario& scenario, std::uint64_t seed, PathTown plan);
  LocalFrame frame_;
  double max_speed_mps_;
  double traffic_;
  double rain_share_;
  Town town_;
  Relief relief_;
  bool real_paths_;  // which are driven as they are, not beside their line
  std::vector<SurveyedDrive> routes_;
  std::vector<std::uint64_t> drive_seeds_;
  Clearance clearance_;
  TownMesh mesh_;
  std::shared_ptr<const RayScene> scene_;
};

}  // namespace mapweld::sim
