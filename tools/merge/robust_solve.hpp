// SPDX-License-Identifier: Apache-2.0
// Solves a pose graph of several chains (odometries) tied by loops of which some are wrong.
//
// One wrong loop ruins plain least squares, and no robust kernel finds the way from a bad start: hence a start along a
// spanning tree of loops that agree with each other, graduated non-convexity (Yang et al., RA-L 2020) to choose the
// loops, a fresh start from the chosen ones, and dynamic covariance scaling (Agarwal et al., ICRA 2013) over all loops
// for the answer.
#pragma once

#include <vector>

#include "tools/merge/pose_graph.hpp"

namespace mapweld::merge {

struct RobustConfig {
  int max_iterations = 40;
  double inlier_chi2 = 30;  // 6 degrees of freedom: 99.9 % of true loops are below 22.5; the rest is for odd noise
  double dcs_phi = 15;
  int gnc_rounds = 20;
};

struct ChainGraph {
  // World pose of node i starts as its pose in the frame of its chain.
  std::vector<geom::Pose3> chain_T_node;
  std::vector<int> chain_of;        // per node
  std::vector<GraphEdge> odometry;  // within chains; connects each
  std::vector<GraphEdge> loops;
  int anchor = 0;  // node; its chain's frame becomes the world
};

struct RobustResult {
  std::vector<geom::Pose3> world_T_node;
  std::vector<double> loop_weight;  // per loop, 0..1
};

// Throws like CheckGraph, also when the loops do not connect all chains.
RobustResult SolveRobust(const ChainGraph& graph, const RobustConfig& config);

}  // namespace mapweld::merge
