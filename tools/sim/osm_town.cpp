// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/osm_town.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <exception>
#include <osmium/handler.hpp>
#include <osmium/io/gzip_compression.hpp>
#include <osmium/io/pbf_input.hpp>
#include <osmium/io/reader.hpp>
#include <osmium/io/xml_input.hpp>
#include <osmium/osm/node.hpp>
#include <osmium/osm/way.hpp>
#include <osmium/visitor.hpp>
#include <stdexcept>
#include <string_view>
#include <unordered_map>

#include "tools/sim/hash_noise.hpp"
#include "tools/sim/house_clearance.hpp"

namespace mapweld::sim {
namespace {

struct RoadClass {
  std::string_view highway;
  double half_width_m;
  bool street;
};
constexpr std::array<RoadClass, 9> kRoadClasses{{{"residential", 3.0, true},
                                                 {"living_street", 2.75, true},
                                                 {"unclassified", 3.0, true},
                                                 {"road", 3.0, true},
                                                 {"tertiary", 3.25, true},
                                                 {"secondary", 3.5, true},
                                                 {"primary", 3.75, true},
                                                 {"service", 2.0, false},
                                                 {"pedestrian", 2.5, false}}};

RoofShape RoofOf(std::string_view tag) {
  if (tag == "flat") return RoofShape::kFlat;
  if (tag == "gabled" || tag == "half-hipped" || tag == "gambrel" || tag == "saltbox") return RoofShape::kGable;
  if (tag == "hipped" || tag == "pyramidal" || tag == "mansard") return RoofShape::kHip;
  return RoofShape::kAny;
}

class NodeHandler : public osmium::handler::Handler {
 public:
  NodeHandler(const LocalFrame& frame, Town& town) : frame_(frame), town_(town) {}
  void node(const osmium::Node& node) {
    if (!node.location().valid()) return;
    const Vec2d position = frame_.ToLocal({node.location().lat(), node.location().lon()});
    positions_.emplace(node.id(), position);
    if (node.tags().has_tag("natural", "tree")) town_.trees.push_back({node.id(), position});
  }
  [[nodiscard]] const std::unordered_map<std::int64_t, Vec2d>& positions() const { return positions_; }

 private:
  const LocalFrame& frame_;
  Town& town_;
  std::unordered_map<std::int64_t, Vec2d> positions_;
};

class WayHandler : public osmium::handler::Handler {
 public:
  WayHandler(const std::unordered_map<std::int64_t, Vec2d>& positions, Town& town)
      : positions_(positions), town_(town) {}
  void way(const osmium::Way& way) {
    ids_.clear();
    line_.clear();
    for (const auto& node : way.nodes()) {
      const auto found = positions_.find(node.ref());
      if (found == positions_.end()) continue;
      if (!ids_.empty() && ids_.back() == node.ref()) continue;
      ids_.push_back(node.ref());
      line_.push_back(found->second);
    }
    if (line_.size() < 2) return;
    if (way.tags().has_key("building")) return AddBuilding(way);
    if (way.tags().has_key("highway")) return AddRoad(way);
    if (way.tags().has_key("barrier")) return AddBarrier(way);
  }

 private:
  void AddBuilding(const osmium::Way& way) {
    if (ids_.front() != ids_.back() || line_.size() < 4) return;
    line_.pop_back();
    double area = SignedArea(line_);
    if (area < 0) line_ = Polyline(line_.rbegin(), line_.rend());
    area = std::abs(area);
    if (area < 4) return;  // survey slips, not houses
    const double height = BuildingHeight_m(way.tags().get_value_by_key("height", ""),
                                           way.tags().get_value_by_key("building:levels", ""), area, way.id());
    town_.buildings.push_back({way.id(), line_, height, RoofOf(way.tags().get_value_by_key("roof:shape", ""))});
  }
  void AddRoad(const osmium::Way& way) {
    const std::string_view highway = way.tags().get_value_by_key("highway");
    for (const RoadClass& c : kRoadClasses) {
      if (c.highway != highway) continue;
      town_.roads.push_back({way.id(), ids_, line_, c.half_width_m, c.street});
      for (const Vec2d& p : line_) town_.bounds.Extend(p);
    }
  }
  void AddBarrier(const osmium::Way& way) {
    const std::string_view kind = way.tags().get_value_by_key("barrier");
    if (kind == "wall") town_.barriers.push_back({way.id(), line_, 1.6, false});
    if (kind == "fence") town_.barriers.push_back({way.id(), line_, 1.2, false});
    if (kind == "hedge") town_.barriers.push_back({way.id(), line_, 1.5, true});
  }
  const std::unordered_map<std::int64_t, Vec2d>& positions_;
  Town& town_;
  std::vector<std::int64_t> ids_;
  Polyline line_;
};

template <typename Handler>
void ReadWith(const std::filesystem::path& file, osmium::osm_entity_bits::type what, Handler& handler) {
  osmium::io::Reader reader{osmium::io::File{file.string()}, what};
  osmium::apply(reader, handler);
  reader.close();
}

}  // namespace

Town ReadOsmTown(const std::filesystem::path& file, const LocalFrame& frame) {
  if (!std::filesystem::is_regular_file(file)) {
    throw std::runtime_error(
        fmt::format("town extract {} does not exist; name an .osm, .osm.gz or .osm.pbf file", file.string()));
  }
  Town town;
  try {
    // Two passes, because an extract may list its ways before its nodes.
    NodeHandler nodes(frame, town);
    ReadWith(file, osmium::osm_entity_bits::node, nodes);
    WayHandler ways(nodes.positions(), town);
    ReadWith(file, osmium::osm_entity_bits::way, ways);
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("town extract {} is damaged or no OpenStreetMap file: {}; download it again",
                                         file.string(), e.what()));
  }
  if (town.buildings.empty() || town.roads.empty()) {
    throw std::runtime_error(fmt::format("town extract {} has {} buildings and {} roads; a simulation needs both",
                                         file.string(), town.buildings.size(), town.roads.size()));
  }
  MoveHousesOffStreets(town);
  return town;
}

double BuildingHeight_m(const std::string& height_tag, const std::string& levels_tag, double area_m2, std::int64_t id) {
  const auto number = [](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end != text.c_str() && value > 0 && value < 400 ? value : 0.0;
  };
  if (const double height = number(height_tag); height > 0) return height;
  if (const double levels = number(levels_tag); levels > 0) return levels * 3.0 + 1.0;
  const std::uint64_t bits = Hash(static_cast<std::uint64_t>(id), 0x4E16);
  if (area_m2 < 35) return Uniform(bits, 2.3, 3.1);   // sheds and garages
  if (area_m2 < 80) return Uniform(bits, 3.0, 5.5);   // annexes and small houses
  if (area_m2 < 400) return Uniform(bits, 5.5, 9.5);  // houses
  return Uniform(bits, 6.0, 12.0);                    // blocks and halls
}

}  // namespace mapweld::sim
