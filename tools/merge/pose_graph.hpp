// SPDX-License-Identifier: Apache-2.0
// Least squares over SE(3) poses tied by relative poses: Levenberg-Marquardt on Eigen's sparse LDL^T.
#pragma once

#include <vector>

#include "core/geom/between_factor.hpp"

namespace mapweld::merge {

struct GraphEdge {
  int a = 0;
  int b = 0;
  geom::Pose3 a_T_b;
  geom::Vec6d sigma = geom::Vec6d::Ones();  // standard deviations: metres, then radians; in the frame of b
  double weight = 1;                        // multiplies the information, 0..1
};

struct PoseGraph {
  std::vector<geom::Pose3> world_T_node;
  std::vector<GraphEdge> edges;
  int anchor = 0;  // the node that stays where it is
};

// Throws std::runtime_error that names the first fault: no node, an anchor or an edge end that does not exist, an edge
// from a node to itself, a pose or a sigma or a weight that is not finite or not a rotation, a sigma that is not
// positive, scales further apart than 1e6, a node that no edge of positive weight ties to the anchor. A solver would
// answer "converged" to most of these.
void CheckGraph(const PoseGraph& graph);

struct SolveReport {
  int iterations = 0;
  bool converged = false;
  double chi2_before = 0;
  double chi2_after = 0;
};

// Checks, then moves all nodes but the anchor. Deterministic. Cost per iteration: one sparse factorisation, about 5 ms
// for 1000 nodes in chains.
SolveReport Solve(PoseGraph* graph, int max_iterations);

// Squared distance of the edge from its measurement in standard deviations, without its weight.
double Chi2(const PoseGraph& graph, const GraphEdge& edge);

}  // namespace mapweld::merge
