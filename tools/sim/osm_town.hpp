// SPDX-License-Identifier: Apache-2.0
// A town as an OpenStreetMap extract describes it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tools/sim/local_frame.hpp"
#include "tools/sim/town.hpp"

namespace mapweld::sim {

// Reads .osm, .osm.gz or .osm.pbf. Ways that refer to nodes outside the extract lose those nodes; houses
// whose corners the map puts on a carriageway are moved off it. Throws
// std::runtime_error for a file that is missing, malformed, or has no streets or no buildings.
Town ReadOsmTown(const std::filesystem::path& file, const LocalFrame& frame);

// What the tags say, in metres; without usable tags a height that fits the footprint's area and is fixed by the id.
double BuildingHeight_m(const std::string& height_tag, const std::string& levels_tag, double area_m2, std::int64_t id);

}  // namespace mapweld::sim
