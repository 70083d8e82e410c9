// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/merge/frame_vote.hpp"

namespace mapweld::merge {

struct ChainStart {
  std::vector<geom::Pose3> world_T_node;
  std::vector<int> root_of;  // per chain: the chain whose frame it was placed in
};

// A start for all nodes along a spanning tree of the votes, those with most support first: their members, and those of
// every triple of chains that closes. The anchor's chain stays,
// and what the votes connect to it is placed by them; every other connected part stands in the frame of its lowest
// chain.
ChainStart StartAlongTree(const ChainGraph& graph, const std::vector<FrameVote>& votes);

}  // namespace mapweld::merge
