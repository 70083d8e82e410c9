// SPDX-License-Identifier: Apache-2.0
// Ceres as the oracle of the pose graph bench; it is no part of what ships.
#pragma once

#include "tools/pose_graph/pose_graph.hpp"

namespace mapweld::bench {

inline constexpr bool kHaveCeres = MAPWELD_HAVE_CERES != 0;

// Levenberg-Marquardt on sparse normal equations, one thread, automatic derivatives, as Ceres' own pose graph example.
// Returns the number of iterations. Without Ceres it does nothing.
int SolveWithCeres(pose_graph::PoseGraph* graph, int max_iterations);

}  // namespace mapweld::bench
