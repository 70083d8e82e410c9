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
  // a vehicle sees the same town alone and in company. Throws std::runtime_error, see ReadOsmTown and PlanStreetPath.
  explicit SimWorld(const Scenario& scenario);

  [[nodiscard]] const LocalFrame& frame() const { return frame_; }
  [[nodiscard]] const Town& town() const { return town_; }
  [[nodiscard]] const StreetPath& route(std::size_t vehicle) const {
    return routes_[vehicle];
  }  // order of the scenario
  [[nodiscard]] std::size_t vehicles() const { return routes_.size(); }
  [[nodiscard]] const TownMesh& mesh() const { return mesh_; }
  [[nodiscard]] const RayCaster& caster() const { return caster_; }

 private:
  LocalFrame frame_;
  Town town_;
  std::vector<StreetPath> routes_;
  TownMesh mesh_;
  RayCaster caster_;
};

}  // namespace mapweld::sim
