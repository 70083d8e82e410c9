// SPDX-License-Identifier: Apache-2.0
// What stands along a street and is on no map: trees, lamp posts, signs, kerbs, garden walls and hedges. Invented, but
// always the same for the same town: every piece depends on ids of the town and its place along the street only.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/sim/clearance.hpp"
#include "tools/sim/plots.hpp"
#include "tools/sim/town_mesh.hpp"

namespace mapweld::sim {

// A trunk and an irregular crown of separate leafy patches, which let part of the beams through.
void AddTree(const Vec2d& foot, std::uint64_t seed, TownMesh& mesh);
void AddGardenWall(const Vec2d& from, const Vec2d& to, double half_width, double height, bool hedge, TownMesh& mesh);

// Nothing touches a carriageway or a building, and junctions stay clear.
void AddRoadside(const std::vector<Plot>& plots, const Clearance& clearance, TownMesh& mesh);

}  // namespace mapweld::sim
