// SPDX-License-Identifier: Apache-2.0
// The part of a CityJSON file (versions 1.0 to 2.0, https://www.cityjson.org/specs) that a town is made of.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace mapweld::sim {

using Ring3 = std::vector<Eigen::Vector3d>;

struct CitySurface {
  std::vector<Ring3> rings;  // the outer one first, then holes
  bool ground = false;       // its semantics say GroundSurface
};

// A city object with its most detailed geometry.
struct CityObject {
  std::string id;
  std::string type;      // "Building", "Road", ...
  std::string function;  // attribute of that name; empty without
  double lod = 0;
  std::vector<CitySurface> surfaces;
};

// Objects with surfaces, by id. Coordinates in metres about the middle of the extent of all vertices; heights as in the
// file. Geometry templates are left out. Throws std::runtime_error that begins with `name` for text that is no
// CityJSON, for indices and coordinates that cannot be, and for coordinates in degrees.
std::vector<CityObject> ParseCityJson(std::string_view text, const std::string& name);

}  // namespace mapweld::sim
