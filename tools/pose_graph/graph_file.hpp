// SPDX-License-Identifier: Apache-2.0
// Between pose graphs in files and in memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/io/g2o.hpp"
#include "tools/pose_graph/pose_graph.hpp"
#include "tools/pose_graph/solve.hpp"

namespace mapweld::pose_graph {

struct LoadedGraph {
  PoseGraph graph;                   // nodes by ascending id, good edges only
  std::vector<std::int64_t> id;      // per node
  std::vector<std::string> refused;  // one sentence per edge that makes no sense, with its line
};

// A file without any vertex gets all that its edges name, at the origin. Held: what the file fixes, and the lowest node
// of every connected component in which nothing is fixed.
LoadedGraph FromFile(const io::PoseGraphFile& file);
// The file again, with the poses of the graph; vertices by id, good edges by vertices.
io::PoseGraphFile ToFile(const LoadedGraph& loaded, const io::PoseGraphFile& file);

// Adds to the held nodes the lowest node of every connected component in which none is held.
void HoldEveryComponent(PoseGraph* graph);

struct ComponentsReport {
  int components = 0;
  int chordal = 0;  // started there
  int not_converged = 0;
  int iterations = 0;      // of the component with the most
  double cost_before = 0;  // sums
  double cost_after = 0;
};

// Solves every connected component on its own: one that finds its way slowly must not hold up the others.
ComponentsReport SolveComponents(PoseGraph* graph, const SolveConfig& config);

}  // namespace mapweld::pose_graph
