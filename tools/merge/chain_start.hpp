// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/merge/robust_solve.hpp"

namespace mapweld::merge {

// A start for all nodes: the anchor's chain stays, others are placed one after the other along a spanning tree. Each
// pair of chains proposes the loop that most others of the pair agree with; pairs with more agreement come first.
// Loops of weight 0.5 or less are used only for chains that no other loop reaches. Chains that no loop reaches at all
// stay in their own frame.
std::vector<geom::Pose3> StartAlongTree(const ChainGraph& graph, const std::vector<double>& loop_weight);

}  // namespace mapweld::merge
