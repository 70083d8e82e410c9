// SPDX-License-Identifier: Apache-2.0
// A scenario made ready to drive: town, streets, routes and the scene for the rays.
#pragma once

#include <vector>

#include "tools/sim/lane_path.hpp"
#include "tools/sim/ray_caster.hpp"
#include "tools/sim/route.hpp"
#include "tools/sim/scenario.hpp"

namespace mapweld::sim {

class SimWorld {
 public:
  // Plans the routes of all vehicles and builds the town around all of them, whichever will be simulated later, so that
  // a vehicle sees the same town alone and in company. `seed` chooses the routes of a survey. Throws
  // std::runtime_error, see ReadOsmTown, PlanStreetPath and PlanSurvey.
  SimWorld(const Scenario& scenario, std::uint64_t seed);

  [[nodiscard]] const LocalFrame& frame() const { return frame_; }
  [[nodiscard]] const Town& town() const { return town_; }
  // In the order of the scenario.
  [[nodiscard]] const StreetPath& route(std::size_t vehicle) const { return routes_[vehicle].path; }
  // Vehicles of different zones share no street.
  [[nodiscard]] int zone(std::size_t vehicle) const { return routes_[vehicle].zone; }
  [[nodiscard]] std::size_t vehicles() const { return routes_.size(); }
  [[nodiscard]] const TownMesh& mesh() const { return mesh_; }
  [[nodiscard]] const RayCaster& caster() const { return caster_; }

 private:
  LocalFrame frame_;
  Town town_;
  std::vector<SurveyedDrive> routes_;
  TownMesh mesh_;
  RayCaster caster_;
};

}  // namespace mapweld::sim
