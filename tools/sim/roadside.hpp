// SPDX-License-Identifier: Apache-2.0
// What stands along a street and is on no map: trees, lamp posts, parked cars, garden walls and hedges. Invented, but
// always the same for the same extract: every piece depends on ids of the map and its place along the street only.
#pragma once

#include <cstdint>

#include "tools/sim/town_mesh.hpp"

namespace mapweld::sim {

// A trunk and an irregular crown of separate leafy patches, which let part of the beams through.
void AddTree(const Vec2d& foot, std::uint64_t seed, TownMesh& mesh);
void AddGardenWall(const Vec2d& from, const Vec2d& to, double half_width, double height, bool hedge, TownMesh& mesh);

// Along all streets within `area`. Nothing touches a carriageway or a building, and junctions stay clear.
void AddRoadside(const Town& town, const Box2& area, TownMesh& mesh);

}  // namespace mapweld::sim
