// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {
namespace {

constexpr double kSightBetweenCandidates_m = 150;

// The nodes of one zone: in the disc, connected, and none of them in a dead end.
std::vector<std::uint32_t> LoopsWithin(const RoadGraph& graph, const Vec2d& centre, double radius_m) {
  std::vector<char> inside(graph.size(), 0);
  std::vector<std::uint32_t> members;
  for (std::uint32_t node = 0; node < graph.size(); ++node) {
    if ((graph.Position(node) - centre).norm() > radius_m) continue;
    inside[node] = 1;
    members.push_back(node);
  }
  const auto degree = [&](std::uint32_t node) {
    const auto& edges = graph.Edges(node);
    return std::count_if(edges.begin(), edges.end(), [&](const RoadGraph::Edge& e) { return inside[e.to] != 0; });
  };
  std::vector<std::uint32_t> open = members;
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    if (inside[node] == 0 || degree(node) >= 2) continue;
    inside[node] = 0;
    for (const RoadGraph::Edge& e : graph.Edges(node)) {
      if (inside[e.to] != 0) open.push_back(e.to);
    }
  }
  std::vector<std::uint32_t> largest;
  for (const std::uint32_t start : members) {
    if (inside[start] != 1) continue;
    std::vector<std::uint32_t> part{start};
    inside[start] = 2;
    for (std::size_t i = 0; i < part.size(); ++i) {
      for (const RoadGraph::Edge& e : graph.Edges(part[i])) {
        if (inside[e.to] != 1) continue;
        inside[e.to] = 2;
        part.push_back(e.to);
      }
    }
    if (part.size() > largest.size()) largest = std::move(part);
  }
  std::sort(largest.begin(), largest.end());
  return largest;
}

std::vector<std::vector<std::uint32_t>> ChooseZones(const RoadGraph& graph, const SurveyPlan& plan) {
  struct Candidate {
    Vec2d centre;
    std::vector<std::uint32_t> nodes;
  };
  std::vector<Candidate> candidates;
  for (std::uint32_t node = 0; node < graph.size(); ++node) {
    const Vec2d& centre = graph.Position(node);
    const bool near_another = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
      return (c.centre - centre).norm() < kSightBetweenCandidates_m;
    });
    if (!near_another) candidates.push_back({centre, LoopsWithin(graph, centre, plan.zone_radius_m)});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.nodes.size() > b.nodes.size(); });
  std::vector<Candidate> chosen;
  for (Candidate& candidate : candidates) {
    if (static_cast<int>(chosen.size()) == plan.zones) break;
    const bool apart = std::all_of(chosen.begin(), chosen.end(), [&](const Candidate& c) {
      return (c.centre - candidate.centre).norm() >= 2 * plan.zone_radius_m + plan.zone_gap_m;
    });
    if (apart && !candidate.nodes.empty()) chosen.push_back(std::move(candidate));
  }
  if (static_cast<int>(chosen.size()) < plan.zones) {
    throw std::runtime_error(fmt::format("the town has room for {} zones of {:.0f} m radius, not for {}", chosen.size(),
                                         plan.zone_radius_m, plan.zones));
  }
  std::vector<std::vector<std::uint32_t>> zones;
  for (Candidate& c : chosen) zones.push_back(std::move(c.nodes));
  return zones;
}

// Exponential above the shortest, scaled so that the sum comes out.
std::vector<double> DrawLengths(const SurveyPlan& plan, std::uint64_t seed) {
  std::vector<double> draws;
  for (int i = 0; i < plan.drives / plan.runs; ++i) {
    draws.push_back(-std::log(1 - Uniform(Hash(seed, 1, static_cast<std::uint64_t>(i)))));
  }
  const auto lengths = [&](double scale_m) {
    std::vector<double> out;
    for (const double d : draws) out.push_back(std::min(plan.min_length_m + scale_m * d, plan.max_length_m));
    return out;
  };
  double low = 0;
  double high = plan.max_length_m * 100;
  for (int round = 0; round < 60; ++round) {
    const double middle = (low + high) / 2;
    double sum = 0;
    for (const double l : lengths(middle)) sum += l;
    (sum * plan.runs < plan.total_length_m ? low : high) = middle;
  }
  return lengths(low);
}

// From one random goal to the next, never straight back.
StreetPath Wander(const RoadGraph& graph, const std::vector<std::uint32_t>& zone, double length_m, std::uint64_t seed) {
  constexpr int kMaxGoals = 5000;
  std::vector<char> allowed(graph.size(), 0);
  for (const std::uint32_t node : zone) allowed[node] = 1;
  std::uint64_t draw = 0;
  const auto random_node = [&] { return zone[Hash(seed, 2, draw++) % zone.size()]; };
  StreetPath path;
  path.nodes.push_back(random_node());
  double driven_m = 0;
  for (int goal = 0; goal < kMaxGoals && driven_m < length_m; ++goal) {
    const std::uint32_t here = path.nodes.back();
    const std::uint32_t before = path.nodes.size() > 1 ? path.nodes[path.nodes.size() - 2] : here;
    const std::vector<std::uint32_t> leg = graph.ShortestPath(
        here, random_node(),
        [&](std::uint32_t a, std::uint32_t b) { return allowed[b] != 0 && !(a == here && b == before); });
    for (std::size_t i = 1; i < leg.size() && driven_m < length_m; ++i) {
      driven_m += (graph.Position(leg[i]) - graph.Position(leg[i - 1])).norm();
      path.nodes.push_back(leg[i]);
    }
  }
  if (driven_m < length_m)
    throw std::runtime_error("a zone of the survey has no loop to drive; choose a larger radius");
  for (const std::uint32_t node : path.nodes) path.centreline.push_back(graph.Position(node));
  return path;
}

// Straight on from a random node at every junction, over streets that are not `taken` yet; takes them. Throws
// std::runtime_error when no way of the length is found.
StreetPath GoStraight(const RoadGraph& graph, const std::vector<std::uint32_t>& zone, double length_m,
                      std::uint64_t seed, std::vector<char>* taken) {
  constexpr std::uint64_t kTries = 2000;
  constexpr double kStraight = 0.6;  // cosine: what turns more is a bend, not the same street
  std::vector<char> allowed(graph.size(), 0);
  for (const std::uint32_t node : zone) allowed[node] = 1;
  for (std::uint64_t attempt = 0; attempt < kTries; ++attempt) {
    StreetPath path;
    path.nodes.push_back(zone[Hash(seed, 4, attempt) % zone.size()]);
    double driven_m = 0;
    while (driven_m < length_m) {
      const std::uint32_t here = path.nodes.back();
      const bool first = path.nodes.size() == 1;
      const Vec2d before = first ? Vec2d(Vec2d::Zero()) : Vec2d(graph.Position(path.nodes[path.nodes.size() - 2]));
      double best = first ? -2 : kStraight;
      std::uint32_t next = here;
      for (const RoadGraph::Edge& e : graph.Edges(here)) {
        // A junction may be crossed by many; the nodes between junctions belong to one street.
        const bool free = (*taken)[e.to] == 0 || graph.Edges(e.to).size() > 2;
        if (allowed[e.to] == 0 || !free || ((*taken)[here] != 0 && (*taken)[e.to] != 0)) continue;
        const Vec2d on = (graph.Position(e.to) - graph.Position(here)).normalized();
        const double straight = first ? 0 : on.dot((graph.Position(here) - before).normalized());
        if (straight <= best) continue;
        best = straight;
        next = e.to;
      }
      if (next == here) break;
      driven_m += (graph.Position(next) - graph.Position(here)).norm();
      path.nodes.push_back(next);
    }
    if (driven_m < length_m) continue;
    for (const std::uint32_t node : path.nodes) {
      (*taken)[node] = 1;
      path.centreline.push_back(graph.Position(node));
    }
    return path;
  }
  throw std::runtime_error(
      "the town has too few long straight streets for the survey; ask for fewer or shorter drives");
}

StreetPath Reversed(StreetPath path) {
  std::reverse(path.nodes.begin(), path.nodes.end());
  std::reverse(path.centreline.begin(), path.centreline.end());
  return path;
}

}  // namespace

std::vector<SurveyedDrive> PlanSurvey(const RoadGraph& graph, const SurveyPlan& plan, std::uint64_t seed) {
  const std::vector<std::vector<std::uint32_t>> zones = ChooseZones(graph, plan);
  const std::vector<double> lengths = DrawLengths(plan, seed);
  std::vector<char> taken(graph.size(), 0);
  std::vector<SurveyedDrive> drives;
  for (int route = 0; route < plan.drives / plan.runs; ++route) {
    const int zone = route % plan.zones;
    const std::vector<std::uint32_t>& nodes = zones[static_cast<std::size_t>(zone)];
    const double length_m = lengths[static_cast<std::size_t>(route)];
    const std::uint64_t route_seed = Hash(seed, 3, static_cast<std::uint64_t>(route));
    const StreetPath path = plan.straight_on ? GoStraight(graph, nodes, length_m, route_seed, &taken)
                                             : Wander(graph, nodes, length_m, route_seed);
    for (int run = 0; run < plan.runs; ++run) drives.push_back({zone, run % 2 == 0 ? path : Reversed(path)});
  }
  return drives;
}

}  // namespace mapweld::sim
