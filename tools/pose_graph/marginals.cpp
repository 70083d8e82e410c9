// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/marginals.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "tools/pose_graph/normal_equations.hpp"

namespace mapweld::pose_graph {

using geom::Mat6d;

Marginals::Marginals(const PoseGraph* graph) : graph_(graph), pattern_(PatternOf(*graph)), inverse_(&pattern_.blocks) {
  NormalEquations equations(graph, &pattern_);
  (void)equations.Linearize(graph->world_T_node);
  std::swap(inverse_, *equations.system());
  if (!inverse_.Factorize()) {
    throw std::runtime_error("pose graph: its edges leave a pose open, which so has no covariance");
  }
  inverse_.InvertInPattern();
}

Mat6d Marginals::OfNode(int node) const {
  const int column = pattern_.column[static_cast<std::size_t>(node)];
  return column < 0 ? Mat6d(Mat6d::Zero()) : inverse_.diagonal(column);
}

Mat6d Marginals::OfEdge(int a, int b) const {
  const geom::Pose3& world_T_a = graph_->world_T_node[static_cast<std::size_t>(a)];
  const geom::Pose3& world_T_b = graph_->world_T_node[static_cast<std::size_t>(b)];
  const geom::BetweenLinearization l = geom::LinearizeBetween(world_T_a, world_T_b, world_T_a.Inverse() * world_T_b);
  Mat6d out = l.jacobian_a * OfNode(a) * l.jacobian_a.transpose() + l.jacobian_b * OfNode(b) * l.jacobian_b.transpose();
  const int column_a = pattern_.column[static_cast<std::size_t>(a)];
  const int column_b = pattern_.column[static_cast<std::size_t>(b)];
  if (column_a < 0 || column_b < 0) return out;
  const Mat6d& block =
      inverse_.lower(pattern_.blocks.BlockAt(std::max(column_a, column_b), std::min(column_a, column_b)));
  const Mat6d ab = column_a > column_b ? block : Mat6d(block.transpose());
  const Mat6d cross = l.jacobian_a * ab * l.jacobian_b.transpose();
  return out + cross + cross.transpose();
}

}  // namespace mapweld::pose_graph
