// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/cityjson_town.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "tools/sim/cityjson_file.hpp"
#include "tools/sim/house_clearance.hpp"
#include "tools/sim/street_lines.hpp"

namespace mapweld::sim {
namespace {

using Eigen::Vector3d;

// How words of a road's function begin that is not for cars, in the languages of the data sets at hand.
constexpr std::array<std::string_view, 11> kNotDriven{"foot", "sidewalk", "cycle", "pedestrian", "parking", "stair",
                                                      "voet", "parkeer",  "fiets", "trap",       "spoor"};

// Positive and the same everywhere: FNV-1a.
std::int64_t IdOf(const std::string& text) {
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  return static_cast<std::int64_t>(hash >> 2U);
}

Polyline Flat(const Ring3& ring) {
  Polyline out;
  for (const Vector3d& p : ring) out.emplace_back(p.head<2>());
  return out;
}

// Twice the area times the normal, whatever the ring's shape.
Vector3d AreaVector(const Ring3& ring) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    sum += (ring[i] - ring.front()).cross(ring[(i + 1) % ring.size()] - ring.front());
  }
  return sum;
}

std::pair<double, double> HeightsOf(const CityObject& object) {
  std::pair<double, double> range{1e300, -1e300};
  for (const CitySurface& surface : object.surfaces) {
    for (const Vector3d& p : surface.rings.front()) {
      range.first = std::min(range.first, p.z());
      range.second = std::max(range.second, p.z());
    }
  }
  return range;
}

// The surfaces whose outline is the footprint: those that say that they are the ground, else the level ones near the
// house's lowest point, else the roof, as many models are open below.
std::vector<const CitySurface*> PlanOf(const CityObject& object) {
  std::vector<const CitySurface*> ground;
  for (const CitySurface& surface : object.surfaces) {
    if (surface.ground) ground.push_back(&surface);
  }
  if (!ground.empty()) return ground;
  const auto [low, high] = HeightsOf(object);
  const double up_to = low + std::max(0.5, 0.2 * (high - low));
  for (const CitySurface& surface : object.surfaces) {
    const Ring3& ring = surface.rings.front();
    const Vector3d area = AreaVector(ring);
    const bool level = std::abs(area.z()) > 0.7 * area.norm();
    const bool deep = std::all_of(ring.begin(), ring.end(), [&](const Vector3d& p) { return p.z() <= up_to; });
    if (level && deep) ground.push_back(&surface);
  }
  if (!ground.empty()) return ground;
  std::vector<const CitySurface*> roof;
  for (const CitySurface& surface : object.surfaces) {
    const Vector3d area = AreaVector(surface.rings.front());
    if (area.z() > 0.2 * area.norm()) roof.push_back(&surface);
  }
  return roof;
}

// The outermost loop of the edges that only one of the surfaces has; empty when they close to no loop.
Polyline Outline(const std::vector<const CitySurface*>& surfaces) {
  using Corner = std::pair<std::int64_t, std::int64_t>;  // millimetres
  const auto corner_of = [](const Vector3d& p) { return Corner{std::llround(p.x() * 1e3), std::llround(p.y() * 1e3)}; };
  std::map<std::pair<Corner, Corner>, int> edges;
  for (const CitySurface* surface : surfaces) {
    for (const Ring3& ring : surface->rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Corner a = corner_of(ring[i]);
        const Corner b = corner_of(ring[(i + 1) % ring.size()]);
        if (a != b) ++edges[std::minmax(a, b)];
      }
    }
  }
  std::map<Corner, std::vector<Corner>> next;
  for (const auto& [edge, count] : edges) {
    if (count % 2 == 0) continue;
    next[edge.first].push_back(edge.second);
    next[edge.second].push_back(edge.first);
  }
  Polyline best;
  while (!next.empty()) {
    Polyline loop;
    const Corner first = next.begin()->first;
    for (Corner here = first;;) {
      loop.emplace_back(static_cast<double>(here.first) * 1e-3, static_cast<double>(here.second) * 1e-3);
      const auto from = next.find(here);
      if (from == next.end()) break;
      const Corner there = from->second.back();
      from->second.pop_back();
      if (from->second.empty()) next.erase(from);
      if (const auto back = next.find(there); back != next.end()) {
        std::erase(back->second, here);
        if (back->second.empty()) next.erase(back);
      }
      here = there;
      if (here == first) break;
    }
    if (std::abs(SignedArea(loop)) > std::abs(SignedArea(best))) best = loop;
  }
  return best;
}

// Without corners that lie on the straight line between their neighbours.
Polyline WithoutStraightCorners(const Polyline& loop) {
  constexpr double kOff_m = 0.05;
  Polyline out;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2d& before = out.empty() ? loop.back() : out.back();
    if (DistanceToSegment(loop[i], before, loop[(i + 1) % loop.size()]) > kOff_m) out.push_back(loop[i]);
  }
  return out;
}

// Level 2 has the roof's real surfaces, of which the shape that covers most counts; what is below has boxes.
RoofShape RoofOf(const CityObject& object) {
  if (object.lod < 2) return RoofShape::kFlat;
  double sloped = 0;
  double level = 0;
  for (const CitySurface& surface : object.surfaces) {
    const Vector3d area = AreaVector(surface.rings.front());
    const double up = surface.ground ? 0 : area.z() / std::max(area.norm(), 1e-9);
    if (up > 0.2) (up < 0.97 ? sloped : level) += area.norm();
  }
  return sloped > level ? RoofShape::kGable : RoofShape::kFlat;
}

void AddBuilding(const CityObject& object, Town* town) {
  constexpr double kSmallest_m2 = 4;
  Polyline footprint = WithoutStraightCorners(Outline(PlanOf(object)));
  if (footprint.size() < 3 || std::abs(SignedArea(footprint)) < kSmallest_m2) return;
  if (SignedArea(footprint) < 0) std::reverse(footprint.begin(), footprint.end());
  const auto [low, high] = HeightsOf(object);
  const double height_m = high - low;
  if (height_m < 1 || height_m > 400) return;  // a terrace, or a slip
  town->buildings.push_back({IdOf(object.id), std::move(footprint), height_m, RoofOf(object)});
}

bool IsDriven(const CityObject& road) {
  std::string word;
  for (const char c : road.function + " ") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      continue;
    }
    const auto begins = [&](std::string_view start) { return word.starts_with(start); };
    if (std::any_of(kNotDriven.begin(), kNotDriven.end(), begins)) return false;
    word.clear();
  }
  return true;
}

}  // namespace

Town ReadCityJsonTown(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw std::runtime_error(
        fmt::format("town model {} does not exist or cannot be read; name a CityJSON file", file.string()));
  }
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  Town town;
  std::vector<Area> carriageways;
  for (const CityObject& object : ParseCityJson(text, fmt::format("town model {}", file.string()))) {
    if (object.type == "Building" || object.type == "BuildingPart") AddBuilding(object, &town);
    if (object.type != "Road" || !IsDriven(object)) continue;
    for (const CitySurface& surface : object.surfaces) {
      Area area;
      for (const Ring3& ring : surface.rings) area.push_back(Flat(ring));
      carriageways.push_back(std::move(area));
    }
  }
  town.roads = StreetLines(carriageways);
  if (town.buildings.empty() || town.roads.empty()) {
    throw std::runtime_error(fmt::format("town model {} has {} buildings and {} streets; a simulation needs both",
                                         file.string(), town.buildings.size(), town.roads.size()));
  }
  for (const Road& road : town.roads) {
    for (const Vec2d& p : road.line) town.bounds.Extend(p);
  }
  MoveHousesOffStreets(town);
  return town;
}

}  // namespace mapweld::sim
