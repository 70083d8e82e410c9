// SPDX-License-Identifier: Apache-2.0
// Solves a pose graph of several chains (odometries) tied by loops of which some are wrong.
//
// One wrong loop ruins plain least squares, and no robust kernel finds the way from a bad start: hence a vote per pair
// of chains, a start along a spanning tree of the votes, graduated non-convexity (Yang et al., RA-L 2020) to choose the
// loops, a fresh start from the chosen ones, and dynamic covariance scaling (Agarwal et al., ICRA 2013) over all loops
// for the answer. Then every pair that ties two chains must fit the answer, or it is taken away and all is done again.
#pragma once

#include <vector>

#include "tools/merge/chain_graph.hpp"

namespace mapweld::merge {

struct RobustConfig {
  int max_iterations = 40;
  double inlier_chi2 = 30;  // 6 degrees of freedom: 99.9 % of true loops are below 22.5; the rest is for odd noise
  double dcs_phi = 15;
  int gnc_rounds = 20;
  // Two chains are tied only by so many loops that agree, from places 10 m apart. A look-alike street gives a few that
  // do. Whoever has verified each loop by other means may ask for less.
  int min_places = 6;
};

struct RobustResult {
  std::vector<geom::Pose3> world_T_node;  // each in the frame of its root
  std::vector<int> root_of;               // per chain: chains with the same root are tied; others share no frame
  std::vector<double> loop_weight;        // per loop, 0..1; 0 between chains that are not tied, and for faulty loops
};

// Loops that are no measurement (pose_graph::FaultOf) count as not there. Throws like pose_graph::CheckGraph for faulty
// odometry and starts.
RobustResult SolveRobust(const ChainGraph& graph, const RobustConfig& config);

}  // namespace mapweld::merge
