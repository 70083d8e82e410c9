// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/graph_pattern.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

namespace mapweld::pose_graph {
namespace {

// Negative, zero or positive, as x comes before y: by bytes, which orders "not a number" too.
int Compare(const double* x, const double* y, std::size_t count) {
  return std::memcmp(x, y, count * sizeof(double));
}

bool Before(const Edge& x, const Edge& y) {
  if (x.a != y.a) return x.a < y.a;
  if (x.b != y.b) return x.b < y.b;
  int order = Compare(x.a_T_b.t.data(), y.a_T_b.t.data(), 3);
  if (order == 0) order = Compare(x.a_T_b.q.coeffs().data(), y.a_T_b.q.coeffs().data(), 4);
  if (order == 0) order = Compare(x.information.data(), y.information.data(), 36);
  if (order == 0) order = Compare(&x.weight, &y.weight, 1);
  return order < 0;
}

}  // namespace

std::vector<std::size_t> OrderOfEdges(const std::vector<Edge>& edges) {
  std::vector<std::size_t> out(edges.size());
  std::iota(out.begin(), out.end(), 0U);
  std::sort(out.begin(), out.end(), [&](std::size_t x, std::size_t y) { return Before(edges[x], edges[y]); });
  return out;
}

GraphPattern PatternOf(const PoseGraph& graph) {
  GraphPattern out;
  std::vector<int> unknown(graph.world_T_node.size(), 0);
  for (const int node : graph.held) unknown[static_cast<std::size_t>(node)] = -1;
  int unknowns = 0;
  for (int& number : unknown) {
    if (number == 0) number = unknowns++;
  }
  std::vector<std::pair<int, int>> ties;
  for (const Edge& edge : graph.edges) {
    const int a = unknown[static_cast<std::size_t>(edge.a)];
    const int b = unknown[static_cast<std::size_t>(edge.b)];
    if (a >= 0 && b >= 0) ties.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(ties.begin(), ties.end());
  ties.erase(std::unique(ties.begin(), ties.end()), ties.end());
  out.blocks = AnalyzePattern(unknowns, ties);
  for (const int number : unknown) {
    out.column.push_back(number < 0 ? -1 : out.blocks.position[static_cast<std::size_t>(number)]);
  }

  for (const std::size_t i : OrderOfEdges(graph.edges)) {
    const Edge& edge = graph.edges[i];
    GraphPattern::Term term{i, out.column[static_cast<std::size_t>(edge.a)],
                            out.column[static_cast<std::size_t>(edge.b)], 0};
    if (term.column_a >= 0 && term.column_b >= 0) {
      term.block = out.blocks.BlockAt(std::max(term.column_a, term.column_b), std::min(term.column_a, term.column_b));
    }
    out.terms.push_back(term);
  }
  return out;
}

}  // namespace mapweld::pose_graph
