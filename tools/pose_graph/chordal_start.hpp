// SPDX-License-Identifier: Apache-2.0
// A start for the solver that needs no start: two linear problems (Carlone, Tron, Daniilidis, Dellaert, "Initialization
// techniques for 3D SLAM", ICRA 2015, section IV).
#pragma once

#include <optional>
#include <vector>

#include "tools/pose_graph/graph_pattern.hpp"

namespace mapweld::pose_graph {

// Rotations that agree with all measured ones in the sense of distances between matrices, each then made a rotation;
// positions that agree with the measured ones under these rotations. Held nodes stay. Nothing when the information of
// the edges does not determine that. Cost: two sparse factorisations with blocks of 3 and of 1.
std::optional<std::vector<geom::Pose3>> ChordalStart(const PoseGraph& graph, const GraphPattern& pattern);

}  // namespace mapweld::pose_graph
