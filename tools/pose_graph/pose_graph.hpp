// SPDX-License-Identifier: Apache-2.0
// Poses tied by measured relative poses: what the solver of this folder works on.
#pragma once

#include <vector>

#include "core/geom/between_factor.hpp"

namespace mapweld::pose_graph {

struct Edge {
  int a = 0;
  int b = 0;
  geom::Pose3 a_T_b;
  // Of the error geom::BetweenResidual: m^-2, rad^-2; in the frame of b. Symmetric, no negative eigenvalue.
  geom::Mat6d information = geom::Mat6d::Identity();
  double weight = 1;  // multiplies the information, 0..1
};

struct PoseGraph {
  std::vector<geom::Pose3> world_T_node;
  std::vector<Edge> edges;
  std::vector<int> held{0};  // nodes that stay where they are, at least one in every connected component
};

// Of independent errors with these standard deviations, metres and radians.
geom::Mat6d InformationOf(const geom::Vec6d& sigma);

// Squared distance of the edge from its measurement in standard deviations, without its weight.
double Chi2(const std::vector<geom::Pose3>& world_T_node, const Edge& edge);

// Half the weighted sum over all edges: what the solver makes small.
double Cost(const PoseGraph& graph);

}  // namespace mapweld::pose_graph
