// SPDX-License-Identifier: Apache-2.0
// How well a solved pose graph knows its poses.
#pragma once

#include <vector>

#include "tools/pose_graph/block_cholesky.hpp"
#include "tools/pose_graph/graph_pattern.hpp"

namespace mapweld::pose_graph {

// Covariances at the solution, of right perturbations (m, rad), as if all measurements were right and independent.
// Cost of the constructor: about three factorisations.
class Marginals {
 public:
  // Throws std::runtime_error when the edges leave a pose open. The graph must outlive this and keep its poses.
  explicit Marginals(const PoseGraph* graph);
  Marginals(const Marginals&) = delete;
  Marginals& operator=(const Marginals&) = delete;

  // Of a node against the held ones; zero for these.
  [[nodiscard]] geom::Mat6d OfNode(int node) const;
  // Of a_T_b as the whole graph knows it, for two nodes that an edge ties.
  [[nodiscard]] geom::Mat6d OfEdge(int a, int b) const;

 private:
  const PoseGraph* graph_;
  GraphPattern pattern_;
  BlockCholesky<6> inverse_;
};

}  // namespace mapweld::pose_graph
