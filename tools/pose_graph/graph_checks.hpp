// SPDX-License-Identifier: Apache-2.0
// What can be wrong with a pose graph before it is solved. A solver would answer "converged" to most of it.
#pragma once

#include <string>
#include <vector>

#include "tools/pose_graph/pose_graph.hpp"

namespace mapweld::pose_graph {

// What is wrong with the edge in a graph of `nodes` nodes, as the end of a sentence ("ties a node to itself"); empty
// when nothing is: ends that exist and differ, a finite measurement with a quaternion of unit length, an information
// that is finite, symmetric, without negative eigenvalues, not zero and nowhere above 1e20, a weight in 0..1.
std::string FaultOf(const Edge& edge, int nodes);

struct RefusedEdge {
  std::size_t index = 0;  // in the graph as it was
  std::string fault;
};

// Takes every faulty edge out and says which.
std::vector<RefusedEdge> RemoveFaultyEdges(PoseGraph* graph);

// Per node the lowest node that edges of positive weight connect it to.
std::vector<int> Components(const PoseGraph& graph);

// Throws std::runtime_error that names the first fault: no node, a held node that does not exist, a start that is not
// finite or not a rotation, a faulty edge, a node that no edge of positive weight ties to a held one.
void CheckGraph(const PoseGraph& graph);

}  // namespace mapweld::pose_graph
