// SPDX-License-Identifier: Apache-2.0
// Which loops between two chains agree with each other, and how the chains then lie to one another, without any common
// frame: pairwise consistent measurements (Mangelson et al., ICRA 2018). Two loops agree when going out by one and back
// by the other, along both odometries, comes back within what loops and odometry are known to be off by.
#pragma once

#include <cstddef>
#include <vector>

#include "tools/merge/chain_graph.hpp"

namespace mapweld::merge {

struct FrameVote {
  int chain_a = 0;  // chain_a < chain_b
  int chain_b = 0;
  geom::Pose3 a_T_b;                 // chain frames, by the loop that most others agree with
  std::vector<std::size_t> members;  // loops, each of which agrees with every other
  int places = 0;                    // of the members, at least 10 m of path apart on both chains
};

// One vote per pair of different chains with a loop of weight above 0.5; only these loops take part. Sorted by chains.
// The largest consistent set is approached greedily. Cost: quadratic in the loops of a pair.
std::vector<FrameVote> VoteOnFrames(const ChainGraph& graph, const std::vector<double>& loop_weight);

}  // namespace mapweld::merge
