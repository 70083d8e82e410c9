// SPDX-License-Identifier: Apache-2.0
// The Gauss-Newton system of a pose graph, one 6 x 6 block per node and tie, and its solution.
#pragma once

#include <vector>

#include "tools/pose_graph/block_cholesky.hpp"
#include "tools/pose_graph/graph_pattern.hpp"

namespace mapweld::pose_graph {

class NormalEquations {
 public:
  // Both must outlive this.
  NormalEquations(const PoseGraph* graph, const GraphPattern* pattern);

  // Puts the system together at these poses; returns the cost there.
  double Linearize(const std::vector<geom::Pose3>& world_T_node);
  // Solves (H + damping * diag(H)) step = -gradient. False when that is not positive definite or the step not finite.
  // Spoils H: linearise before the next one.
  bool Solve(double damping);

  // Of the last Solve: the right perturbation of a node, zero for held ones.
  [[nodiscard]] geom::Vec6d Step(int node) const;
  // Metres and radians, of any node.
  [[nodiscard]] double LargestStep() const { return largest_step_; }

  // H after Linearize, its factor after Solve.
  BlockCholesky<6>* system() { return &system_; }

 private:
  const PoseGraph* graph_;
  const GraphPattern* pattern_;
  std::vector<geom::Mat3d> world_R_node_;
  BlockCholesky<6> system_;
  BlockCholesky<6>::Rhs<1> gradient_;
  BlockCholesky<6>::Rhs<1> step_;
  double largest_step_ = 0;
};

}  // namespace mapweld::pose_graph
