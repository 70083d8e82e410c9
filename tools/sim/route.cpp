// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/route.hpp"

#include <fmt/format.h>

#include <set>
#include <stdexcept>
#include <utility>

namespace mapweld::sim {
namespace {

constexpr double kMaxSnap_m = 40;

std::string Describe(const std::string& who, std::size_t index, GeoPoint p) {
  return fmt::format("{}, waypoint {} ({:.6f}, {:.6f})", who, index + 1, p.lat_deg, p.lon_deg);
}

}  // namespace

StreetPath PlanStreetPath(const RoadGraph& graph, const Box2& bounds, const LocalFrame& frame,
                          const std::vector<GeoPoint>& waypoints, const std::string& who) {
  if (waypoints.size() < 2) throw std::runtime_error(fmt::format("{}: a route needs at least two waypoints", who));
  StreetPath path;
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const Vec2d wanted = frame.ToLocal(waypoints[i]);
    if (!bounds.Grown(kMaxSnap_m).Contains(wanted)) {
      throw std::runtime_error(fmt::format("{} lies outside the town extract; choose a point on its streets",
                                           Describe(who, i, waypoints[i])));
    }
    const std::uint32_t node = graph.NearestNode(wanted);
    const double off = (graph.Position(node) - wanted).norm();
    if (off > kMaxSnap_m) {
      throw std::runtime_error(fmt::format("{} is {:.0f} m away from the nearest street; move it to within {:.0f} m",
                                           Describe(who, i, waypoints[i]), off, kMaxSnap_m));
    }
    if (i > 0) {
      const auto leg = graph.ShortestPath(before, node);
      if (leg.empty()) {
        throw std::runtime_error(
            fmt::format("{} cannot be reached by street from the one before", Describe(who, i, waypoints[i])));
      }
      path.nodes.insert(path.nodes.end(), leg.begin() + 1, leg.end());
    } else {
      path.nodes.push_back(node);
    }
    before = node;
  }
  for (std::size_t i = 0; i < path.nodes.size(); ++i) {
    if (i >= 2 && path.nodes[i] == path.nodes[i - 2]) {
      const GeoPoint at = frame.ToGeo(graph.Position(path.nodes[i - 1]));
      throw std::runtime_error(
          fmt::format("{}: the route turns back on itself at ({:.6f}, {:.6f}); move the waypoint there", who,
                      at.lat_deg, at.lon_deg));
    }
    path.centreline.push_back(graph.Position(path.nodes[i]));
  }
  if (Length(path.centreline) < 30) {
    throw std::runtime_error(
        fmt::format("{}: the route is {:.0f} m long; it needs at least 30 m", who, Length(path.centreline)));
  }
  return path;
}

SharedStreet FindSharedStreet(const StreetPath& a, const StreetPath& b) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges_of_a;
  for (std::size_t i = 1; i < a.nodes.size(); ++i) edges_of_a.emplace(a.nodes[i - 1], a.nodes[i]);
  SharedStreet shared;
  for (std::size_t i = 1; i < b.nodes.size(); ++i) {
    const double length = (b.centreline[i] - b.centreline[i - 1]).norm();
    if (edges_of_a.contains({b.nodes[i - 1], b.nodes[i]})) shared.same_direction_m += length;
    if (edges_of_a.contains({b.nodes[i], b.nodes[i - 1]})) shared.opposite_direction_m += length;
  }
  return shared;
}

}  // namespace mapweld::sim
