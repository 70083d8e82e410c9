// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/pose_graph.hpp"

namespace mapweld::pose_graph {

geom::Mat6d InformationOf(const geom::Vec6d& sigma) {
  return geom::Vec6d(sigma.array().square().inverse()).asDiagonal();
}

double Chi2(const std::vector<geom::Pose3>& world_T_node, const Edge& edge) {
  const geom::Vec6d residual = geom::BetweenResidual(world_T_node[static_cast<std::size_t>(edge.a)],
                                                     world_T_node[static_cast<std::size_t>(edge.b)], edge.a_T_b);
  return residual.dot(edge.information * residual);
}

double Cost(const PoseGraph& graph) {
  double sum = 0;
  for (const Edge& edge : graph.edges) sum += edge.weight * Chi2(graph.world_T_node, edge);
  return 0.5 * sum;
}

}  // namespace mapweld::pose_graph
