// SPDX-License-Identifier: Apache-2.0
// Which node of a pose graph is which unknown, and which block each edge touches.
#pragma once

#include <vector>

#include "tools/pose_graph/block_pattern.hpp"
#include "tools/pose_graph/pose_graph.hpp"

namespace mapweld::pose_graph {

struct GraphPattern {
  struct Term {
    std::size_t edge;  // index in the graph
    int column_a;      // column of the factor, -1 for a held node
    int column_b;
    std::size_t block;  // of the pair, where both are unknown
  };
  std::vector<int> column;  // per node; -1 for held ones
  BlockPattern blocks;
  std::vector<Term> terms;  // sorted by nodes and measurement: sums have the same bits however edges are listed
};

// Indices into `edges`, by nodes, then by the numbers of the measurement.
std::vector<std::size_t> OrderOfEdges(const std::vector<Edge>& edges);

// Held nodes, edge ends and the number of nodes must stay as they are; poses and weights may change.
GraphPattern PatternOf(const PoseGraph& graph);

}  // namespace mapweld::pose_graph
