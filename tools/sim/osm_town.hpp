// SPDX-License-Identifier: Apache-2.0
// A town as an OpenStreetMap extract describes it, in metres: footprints with heights, roads, garden barriers and
// trees.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/sim/local_frame.hpp"
#include "tools/sim/polygon.hpp"

namespace mapweld::sim {

struct Building {
  std::int64_t id = 0;
  Polyline footprint;  // counter-clockwise, first point not repeated
  double height_m = 0;
};

struct Road {
  std::int64_t id = 0;
  std::vector<std::int64_t> nodes;  // shared node ids are junctions
  Polyline line;                    // same length as nodes
  double half_width_m = 0;          // of the carriageway
  bool street = true;               // false: service ways, which routes do not use
};

struct Barrier {
  std::int64_t id = 0;
  Polyline line;
  double height_m = 0;
  bool hedge = false;
};

struct Tree {
  std::int64_t id = 0;
  Vec2d position;
};

struct Town {
  std::vector<Building> buildings;  // all four in the order of the extract
  std::vector<Road> roads;
  std::vector<Barrier> barriers;
  std::vector<Tree> trees;
  Box2 bounds;  // of the roads
};

// Reads .osm, .osm.gz or .osm.pbf. Ways that refer to nodes outside the extract lose those nodes; houses
// whose corners the map puts on a carriageway are moved off it. Throws
// std::runtime_error for a file that is missing, malformed, or has no streets or no buildings.
Town ReadOsmTown(const std::filesystem::path& file, const LocalFrame& frame);

// What the tags say, in metres; without usable tags a height that fits the footprint's area and is fixed by the id.
double BuildingHeight_m(const std::string& height_tag, const std::string& levels_tag, double area_m2, std::int64_t id);

}  // namespace mapweld::sim
