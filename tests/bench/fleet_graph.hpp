// SPDX-License-Identifier: Apache-2.0
// Three vehicles in one town with drifting odometry and loops between them, of which some are wrong: what the robust
// solver is judged by.
#pragma once

#include <vector>

#include "tools/merge/chain_graph.hpp"

namespace mapweld::bench {

struct FleetConfig {
  int vehicles = 3;
  int poses = 400;  // per vehicle, 5 m apart
  int blocks = 4;   // the town is a square of so many blocks of 100 m
  int true_loops = 120;
  double wrong_share = 0;  // of all loops
  int wrong_group = 1;     // wrong loops that agree with each other, as along a look-alike street; 1: each on its own
  bool known_frames = false;   // the vehicles start from the truth, and only drift apart
  bool shared_streets = true;  // false: vehicle k drives in a town of its own, k * 100 km away; no loop is true
  unsigned seed = 1;
};

struct FleetGraph {
  merge::ChainGraph graph;
  std::vector<geom::Pose3> truth;
  std::vector<bool> is_true;  // per loop
};

// Odometry: 0.05 m and 0.003 rad per 5 m; loops: 0.2 m and 0.01 rad. True loops tie poses within 4 m, of two vehicles
// or of one that comes back; wrong ones claim that for poses at least 30 m apart.
FleetGraph MakeFleet(const FleetConfig& config);

// Root mean square of the distances after one rigid alignment of all poses.
double AbsoluteError(const std::vector<geom::Pose3>& estimate, const std::vector<geom::Pose3>& truth);

}  // namespace mapweld::bench
