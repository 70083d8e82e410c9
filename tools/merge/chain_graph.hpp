// SPDX-License-Identifier: Apache-2.0
// Odometries of several drives, each in a frame of its own, and the loops between them: what the robust solver gets.
#pragma once

#include <vector>

#include "tools/pose_graph/pose_graph.hpp"

namespace mapweld::merge {

struct ChainGraph {
  std::vector<geom::Pose3> chain_T_node;   // nodes of one chain follow one another
  std::vector<int> chain_of;               // per node, 0, 1, ...
  std::vector<pose_graph::Edge> odometry;  // each from a node to the next one of its chain
  std::vector<pose_graph::Edge> loops;
  int anchor = 0;  // node; its chain's frame becomes the world

  [[nodiscard]] int chains() const { return chain_of.empty() ? 0 : chain_of.back() + 1; }
  [[nodiscard]] int ChainOf(int node) const { return chain_of[static_cast<std::size_t>(node)]; }
};

}  // namespace mapweld::merge
