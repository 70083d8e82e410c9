// SPDX-License-Identifier: Apache-2.0
// A house as triangles: walls with recessed windows and doors and balconies, under a gable, a hip or a flat roof. What
// the map does not say follows from the house's id.
#pragma once

#include "tools/sim/town_mesh.hpp"

namespace mapweld::sim {

// On flat ground. Not `detailed`: plain walls.
void AddBuilding(const Building& building, bool detailed, TownMesh& mesh);

// A wall above the ground from a to b, seen from the right-hand side, with rows of windows; `seed` is the house's.
void AddFacade(const Vec2d& a, const Vec2d& b, double height, std::uint64_t seed, TownMesh& mesh);

}  // namespace mapweld::sim
