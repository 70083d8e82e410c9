// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/graph_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "tools/pose_graph/block_kernels.hpp"

namespace mapweld::pose_graph {
namespace {

constexpr double kGreatestInformation = 1e20;  // 0.1 nm

void Refuse(const std::string& fault) {
  throw std::runtime_error("pose graph: " + fault);
}

std::string FaultOfInformation(const geom::Mat6d& information) {
  if (!information.allFinite()) return "has an information that is not finite";
  const double greatest = information.cwiseAbs().maxCoeff();
  if (greatest == 0) return "has an information of zero";
  if (greatest > kGreatestInformation) return fmt::format("has an information of {:g}, above 1e20", greatest);
  if ((information - information.transpose()).cwiseAbs().maxCoeff() > 1e-9 * greatest)
    return "has an information that is not symmetric";
  // With a little added, so that a matrix with an eigenvalue of zero passes.
  geom::Mat6d raised = information;
  raised.diagonal().array() += 1e-9 * greatest;
  if (!FactorizeBlock<6>(raised.data())) return "has an information with a negative eigenvalue";
  return {};
}

}  // namespace

std::string FaultOf(const Edge& edge, int nodes) {
  if (edge.a < 0 || edge.b < 0 || edge.a >= nodes || edge.b >= nodes) return "ends at a node that does not exist";
  if (edge.a == edge.b) return "ties a node to itself";
  if (!edge.a_T_b.t.allFinite() || !edge.a_T_b.q.coeffs().allFinite()) return "is not finite";
  if (!edge.a_T_b.IsValid()) return "has a quaternion that is not of unit length";
  if (!(edge.weight >= 0 && edge.weight <= 1)) return "has a weight outside 0..1";
  return FaultOfInformation(edge.information);
}

std::vector<RefusedEdge> RemoveFaultyEdges(PoseGraph* graph) {
  std::vector<RefusedEdge> refused;
  std::vector<Edge> good;
  for (std::size_t i = 0; i < graph->edges.size(); ++i) {
    std::string fault = FaultOf(graph->edges[i], static_cast<int>(graph->world_T_node.size()));
    if (fault.empty()) {
      good.push_back(graph->edges[i]);
    } else {
      refused.push_back({i, std::move(fault)});
    }
  }
  graph->edges = std::move(good);
  return refused;
}

std::vector<int> Components(const PoseGraph& graph) {
  std::vector<int> root(graph.world_T_node.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int node) {
    while (root[static_cast<std::size_t>(node)] != node) {
      int& up = root[static_cast<std::size_t>(node)];
      up = root[static_cast<std::size_t>(up)];
      node = up;
    }
    return node;
  };
  for (const Edge& edge : graph.edges) {
    if (edge.weight <= 0) continue;
    const int a = find(edge.a);
    const int b = find(edge.b);
    root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  for (int node = 0; node < static_cast<int>(root.size()); ++node) root[static_cast<std::size_t>(node)] = find(node);
  return root;
}

void CheckGraph(const PoseGraph& graph) {
  const int nodes = static_cast<int>(graph.world_T_node.size());
  if (nodes == 0) Refuse("it has no nodes");
  for (const int node : graph.held) {
    if (node < 0 || node >= nodes) Refuse(fmt::format("the held node {} does not exist", node));
  }
  for (int i = 0; i < nodes; ++i) {
    if (!graph.world_T_node[static_cast<std::size_t>(i)].IsValid())
      Refuse(fmt::format("the start of node {} is not a pose", i));
  }
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const std::string fault = FaultOf(graph.edges[i], nodes);
    if (!fault.empty()) Refuse(fmt::format("edge {} ({} to {}) {}", i, graph.edges[i].a, graph.edges[i].b, fault));
  }
  const std::vector<int> component = Components(graph);
  std::vector<bool> held(component.size(), false);
  for (const int node : graph.held) {
    held[static_cast<std::size_t>(component[static_cast<std::size_t>(node)])] = true;
  }
  for (int i = 0; i < nodes; ++i) {
    if (!held[static_cast<std::size_t>(component[static_cast<std::size_t>(i)])])
      Refuse(fmt::format("node {} is not connected to a held node", i));
  }
}

}  // namespace mapweld::pose_graph
