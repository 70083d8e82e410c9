// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tools/merge/pose_graph.hpp"

namespace mapweld::merge {
namespace {

constexpr double kGreatestRatio = 1e6;

void Refuse(const std::string& fault) {
  throw std::runtime_error("pose graph: " + fault);
}

void CheckEdge(const GraphEdge& edge, std::size_t index, int nodes) {
  const auto name = [&] { return fmt::format("edge {} ({} to {}) ", index, edge.a, edge.b); };
  if (edge.a < 0 || edge.b < 0 || edge.a >= nodes || edge.b >= nodes)
    Refuse(name() + "ends at a node that does not exist");
  if (edge.a == edge.b) Refuse(name() + "ties a node to itself");
  if (!edge.a_T_b.t.allFinite() || !edge.a_T_b.q.coeffs().allFinite()) Refuse(name() + "is not finite");
  if (!edge.a_T_b.IsValid()) Refuse(name() + "has a quaternion that is not of unit length");
  if (!edge.sigma.allFinite() || !(edge.sigma.array() > 0).all()) Refuse(name() + "has a sigma that is not positive");
  if (!(edge.weight >= 0 && edge.weight <= 1)) Refuse(name() + "has a weight outside 0..1");
}

void CheckConnected(const PoseGraph& graph) {
  std::vector<std::vector<int>> neighbours(graph.world_T_node.size());
  for (const GraphEdge& edge : graph.edges) {
    if (edge.weight <= 0) continue;
    neighbours[static_cast<std::size_t>(edge.a)].push_back(edge.b);
    neighbours[static_cast<std::size_t>(edge.b)].push_back(edge.a);
  }
  std::vector<bool> reached(graph.world_T_node.size(), false);
  std::vector<int> open{graph.anchor};
  reached[static_cast<std::size_t>(graph.anchor)] = true;
  while (!open.empty()) {
    const auto at = static_cast<std::size_t>(open.back());
    open.pop_back();
    for (const int next : neighbours[at]) {
      if (reached[static_cast<std::size_t>(next)]) continue;
      reached[static_cast<std::size_t>(next)] = true;
      open.push_back(next);
    }
  }
  const auto lost = std::find(reached.begin(), reached.end(), false);
  if (lost != reached.end()) {
    Refuse(fmt::format("node {} is not connected to the anchor, node {}", lost - reached.begin(), graph.anchor));
  }
}

}  // namespace

void CheckGraph(const PoseGraph& graph) {
  const int nodes = static_cast<int>(graph.world_T_node.size());
  if (nodes == 0) Refuse("it has no nodes");
  if (graph.anchor < 0 || graph.anchor >= nodes)
    Refuse(fmt::format("the anchor, node {}, does not exist", graph.anchor));
  for (int i = 0; i < nodes; ++i) {
    if (!graph.world_T_node[static_cast<std::size_t>(i)].IsValid())
      Refuse(fmt::format("the start of node {} is not a pose", i));
  }
  double least = std::numeric_limits<double>::infinity();
  double greatest = 0;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    CheckEdge(graph.edges[i], i, nodes);
    least = std::min(least, graph.edges[i].sigma.minCoeff());
    greatest = std::max(greatest, graph.edges[i].sigma.maxCoeff());
  }
  if (greatest > kGreatestRatio * least) {
    Refuse(fmt::format("sigmas from {} to {} are too far apart to solve for", least, greatest));
  }
  CheckConnected(graph);
}

}  // namespace mapweld::merge
