// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/graph_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tools/pose_graph/graph_checks.hpp"

namespace mapweld::pose_graph {
namespace {

std::vector<io::PoseGraphVertex> VerticesOf(const io::PoseGraphFile& file) {
  std::vector<io::PoseGraphVertex> out = file.vertices;
  if (out.empty()) {
    for (const io::PoseGraphEdge& edge : file.edges) {
      out.push_back({edge.a, {}, false});
      out.push_back({edge.b, {}, false});
    }
  }
  std::sort(out.begin(), out.end(), [](const auto& x, const auto& y) { return x.id < y.id; });
  out.erase(std::unique(out.begin(), out.end(), [](const auto& x, const auto& y) { return x.id == y.id; }), out.end());
  return out;
}

int IndexOf(const std::vector<std::int64_t>& id, std::int64_t wanted) {
  const auto at = std::lower_bound(id.begin(), id.end(), wanted);
  return at != id.end() && *at == wanted ? static_cast<int>(at - id.begin()) : -1;
}

}  // namespace

void HoldEveryComponent(PoseGraph* graph) {
  const std::vector<int> component = Components(*graph);
  std::vector<bool> held(component.size(), false);
  const auto root = [&](int node) { return static_cast<std::size_t>(component[static_cast<std::size_t>(node)]); };
  for (const int node : graph->held) held[root(node)] = true;
  for (int node = 0; node < static_cast<int>(component.size()); ++node) {
    if (held[root(node)]) continue;
    held[root(node)] = true;
    graph->held.push_back(node);
  }
  std::sort(graph->held.begin(), graph->held.end());
}

LoadedGraph FromFile(const io::PoseGraphFile& file) {
  LoadedGraph out;
  out.graph.held.clear();
  for (const io::PoseGraphVertex& vertex : VerticesOf(file)) {
    if (vertex.fixed) out.graph.held.push_back(static_cast<int>(out.id.size()));
    out.id.push_back(vertex.id);
    out.graph.world_T_node.push_back(vertex.world_T_vertex);
  }
  const int nodes = static_cast<int>(out.id.size());
  for (const io::PoseGraphEdge& edge : file.edges) {
    const Edge read{IndexOf(out.id, edge.a), IndexOf(out.id, edge.b), edge.a_T_b, edge.information, 1};
    const std::string fault = FaultOf(read, nodes);
    if (fault.empty()) {
      out.graph.edges.push_back(read);
    } else {
      out.refused.push_back(fmt::format("line {}: the edge from {} to {} {}", edge.line, edge.a, edge.b, fault));
    }
  }
  HoldEveryComponent(&out.graph);
  return out;
}

io::PoseGraphFile ToFile(const LoadedGraph& loaded, const io::PoseGraphFile& file) {
  io::PoseGraphFile out;
  for (std::size_t i = 0; i < loaded.id.size(); ++i)
    out.vertices.push_back({loaded.id[i], loaded.graph.world_T_node[i]});
  for (const io::PoseGraphVertex& vertex : file.vertices) {
    if (vertex.fixed) out.vertices[static_cast<std::size_t>(IndexOf(loaded.id, vertex.id))].fixed = true;
  }
  for (const Edge& edge : loaded.graph.edges) {
    out.edges.push_back({loaded.id[static_cast<std::size_t>(edge.a)], loaded.id[static_cast<std::size_t>(edge.b)],
                         edge.a_T_b, edge.information});
  }
  return out;
}

ComponentsReport SolveComponents(PoseGraph* graph, const SolveConfig& config) {
  const std::vector<int> component = Components(*graph);
  struct Part {
    PoseGraph graph;
    std::vector<std::size_t> nodes;
  };
  std::map<int, Part> parts;
  std::vector<int> local(component.size());
  for (std::size_t i = 0; i < component.size(); ++i) {
    Part& part = parts[component[i]];
    local[i] = static_cast<int>(part.nodes.size());
    part.nodes.push_back(i);
    part.graph.world_T_node.push_back(graph->world_T_node[i]);
    part.graph.held.clear();
  }
  const auto part_of = [&](int node) -> Part& { return parts[component[static_cast<std::size_t>(node)]]; };
  for (const int node : graph->held) part_of(node).graph.held.push_back(local[static_cast<std::size_t>(node)]);
  for (const Edge& edge : graph->edges) {
    Edge moved = edge;
    moved.a = local[static_cast<std::size_t>(edge.a)];
    moved.b = local[static_cast<std::size_t>(edge.b)];
    part_of(edge.a).graph.edges.push_back(moved);
  }
  ComponentsReport out;
  for (auto& [first, part] : parts) {
    const SolveReport report = Solve(&part.graph, config);
    ++out.components;
    out.chordal += report.chordal ? 1 : 0;
    out.not_converged += report.converged ? 0 : 1;
    out.iterations = std::max(out.iterations, report.iterations);
    out.cost_before += report.cost_before;
    out.cost_after += report.cost_after;
    for (std::size_t i = 0; i < part.nodes.size(); ++i) {
      graph->world_T_node[part.nodes[i]] = part.graph.world_T_node[i];
    }
  }
  return out;
}

}  // namespace mapweld::pose_graph
