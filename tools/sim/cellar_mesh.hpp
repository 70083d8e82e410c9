// SPDX-License-Identifier: Apache-2.0
// The cellar of a town as triangles: floor, ceiling and outer walls of its level part, walls of its ramps.
#pragma once

#include <vector>

#include "tools/sim/town_mesh.hpp"

namespace mapweld::sim {

// A street that goes down into the cellar, and half the width of the trench in which it does.
struct Ramp {
  Polyline line;
  double half_width_m = 0;
};

// All roads that cross the cellar's edge; none without a cellar.
std::vector<Ramp> RampsOf(const Town& town);

// True in a trench, where the ground is open.
bool InTrench(const Ramp& ramp, const Cellar& cellar, const Vec2d& p);

// Floor and ceiling in pieces of 10 m, for single precision's sake; walls and lintels.
void AddCellar(const Town& town, TownMesh* mesh);

}  // namespace mapweld::sim
