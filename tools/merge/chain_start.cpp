// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/chain_start.hpp"

#include <algorithm>

namespace mapweld::merge {

using geom::Pose3;

ChainStart StartAlongTree(const ChainGraph& graph, std::vector<FrameVote> votes) {
  std::stable_sort(votes.begin(), votes.end(),
                   [](const FrameVote& x, const FrameVote& y) { return x.members.size() > y.members.size(); });
  const auto chains = static_cast<std::size_t>(graph.chains());
  std::vector<Pose3> root_T_chain(chains);
  ChainStart out;
  out.root_of.assign(chains, -1);
  const auto grow = [&](std::size_t root) {
    out.root_of[root] = static_cast<int>(root);
    for (bool grown = true; grown;) {
      grown = false;
      for (const FrameVote& vote : votes) {
        const auto a = static_cast<std::size_t>(vote.chain_a);
        const auto b = static_cast<std::size_t>(vote.chain_b);
        if ((out.root_of[a] < 0) == (out.root_of[b] < 0)) continue;
        if (out.root_of[b] < 0) {
          root_T_chain[b] = root_T_chain[a] * vote.a_T_b;
        } else {
          root_T_chain[a] = root_T_chain[b] * vote.a_T_b.Inverse();
        }
        out.root_of[a] = out.root_of[b] = static_cast<int>(root);
        grown = true;
        break;
      }
    }
  };
  if (chains > 0) grow(static_cast<std::size_t>(graph.ChainOf(graph.anchor)));
  for (std::size_t chain = 0; chain < chains; ++chain) {
    if (out.root_of[chain] < 0) grow(chain);
  }
  for (std::size_t i = 0; i < graph.chain_T_node.size(); ++i) {
    out.world_T_node.push_back(root_T_chain[static_cast<std::size_t>(graph.chain_of[i])] * graph.chain_T_node[i]);
  }
  return out;
}

}  // namespace mapweld::merge
