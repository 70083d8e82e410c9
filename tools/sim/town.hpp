// SPDX-License-Identifier: Apache-2.0
// A town on paper, in metres: footprints with heights, roads, garden barriers and trees. From a map (osm_town.hpp) or
// invented (procedural_town.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/sim/cellar.hpp"
#include "tools/sim/polygon.hpp"

namespace mapweld::sim {

// kAny: what suits the house.
enum class RoofShape : std::uint8_t { kAny, kFlat, kGable, kHip };

struct Building {
  std::int64_t id = 0;
  Polyline footprint;   // counter-clockwise, first point not repeated
  double height_m = 0;  // of the ridge
  RoofShape roof = RoofShape::kAny;
};

// A way under ground or under a house: closed at both sides and above, open at its ends.
struct Passage {
  std::int64_t id = 0;
  Polyline line;
  double half_width_m = 0;
  double height_m = 0;
  double open_m = 0;  // of its walls at either end, for those that cross there
};

struct Road {
  std::int64_t id = 0;
  std::vector<std::int64_t> nodes;  // shared node ids are junctions
  Polyline line;                    // same length as nodes
  double half_width_m = 0;          // of the carriageway
  bool street = true;               // false: service ways, which routes do not use
  bool furnished = true;            // false: a highway, without parked cars, gardens and lamps
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
  std::vector<Building> buildings;  // all five in the order of the source
  std::vector<Road> roads;
  std::vector<Barrier> barriers;
  std::vector<Tree> trees;
  std::vector<Passage> passages;
  std::optional<Cellar> cellar;  // its streets are passages; its ramps are roads that cross its edge
  Box2 bounds;                   // of the roads
};

}  // namespace mapweld::sim
