// SPDX-License-Identifier: Apache-2.0
// Where streets run, from the areas that they cover: maps of cities draw carriageways as areas, routes need lines.
#pragma once

#include <vector>

#include "tools/sim/town.hpp"

namespace mapweld::sim {

// An area as its rings, holes among them; what an odd number of them encloses belongs to it.
using Area = std::vector<Polyline>;

// The middle lines of all areas together, cut at junctions, with their median width. Areas that touch are one. Dead
// ends shorter than 12 m are corners of junctions and are left out. Ids from 1. Method: a raster of half a metre,
// thinned to lines one cell wide (Zhang and Suen, 1984). Cost: cells times half of the widest street in cells; throws
// std::runtime_error when the areas' box has more than 100 million cells, 25 square kilometres, or an area is wider
// than 200 m.
std::vector<Road> StreetLines(const std::vector<Area>& carriageways);

}  // namespace mapweld::sim
