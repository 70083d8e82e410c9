// SPDX-License-Identifier: Apache-2.0
// A town as a CityJSON model describes it: houses with measured heights, streets where its carriageways are.
#pragma once

#include <filesystem>

#include "tools/sim/town.hpp"

namespace mapweld::sim {

// World frame: the axes of the file's reference system, metres from the middle of its extent. Its relief is left out:
// houses are as high as their walls and roofs, and stand on level ground. Roads whose function names footpaths, cycle
// tracks, stairs or parking are not driven on. Houses on a street are moved off it. Throws std::runtime_error for a
// file that is missing, malformed, or has no streets or no buildings.
Town ReadCityJsonTown(const std::filesystem::path& file);

}  // namespace mapweld::sim
