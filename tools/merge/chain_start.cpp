// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/chain_start.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

namespace mapweld::merge {
namespace {

using geom::Pose3;

// How far apart the two ways to a third chain may end: a start needs no more, and a wrong pair is off by a street.
constexpr double kClose_m = 5;
constexpr double kClosePerPath = 0.03;

// The first, the middle and the last node of a chain, and how long it is.
struct Probe {
  std::array<geom::Vec3d, 3> points;
  double path_m = 0;
};

std::vector<Probe> Probes(const ChainGraph& graph) {
  std::vector<Probe> out(static_cast<std::size_t>(graph.chains()));
  const std::size_t n = graph.chain_of.size();
  for (std::size_t begin = 0; begin < n;) {
    std::size_t end = begin + 1;
    Probe& probe = out[static_cast<std::size_t>(graph.chain_of[begin])];
    while (end < n && graph.chain_of[end] == graph.chain_of[begin]) {
      probe.path_m += (graph.chain_T_node[end].t - graph.chain_T_node[end - 1].t).norm();
      ++end;
    }
    probe.points = {graph.chain_T_node[begin].t, graph.chain_T_node[(begin + end) / 2].t,
                    graph.chain_T_node[end - 1].t};
    begin = end;
  }
  return out;
}

std::vector<std::size_t> Supports(const ChainGraph& graph, const std::vector<FrameVote>& votes) {
  std::map<std::pair<int, int>, std::size_t> vote_of;
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    vote_of[{votes[i].chain_a, votes[i].chain_b}] = i;
    out.push_back(votes[i].members.size());
  }
  const std::vector<Probe> probes = Probes(graph);
  for (const auto& [ab, i] : vote_of) {
    for (auto at = vote_of.upper_bound(ab); at != vote_of.end() && at->first.first == ab.first; ++at) {
      const int c = at->first.second;
      const auto bc = vote_of.find({ab.second, c});
      if (bc == vote_of.end()) continue;
      const Pose3 round = votes[i].a_T_b * votes[bc->second].a_T_b;
      const Probe& probe = probes[static_cast<std::size_t>(c)];
      const double longest_m = std::max({probe.path_m, probes[static_cast<std::size_t>(ab.first)].path_m,
                                         probes[static_cast<std::size_t>(ab.second)].path_m});
      const bool closes = std::all_of(probe.points.begin(), probe.points.end(), [&](const geom::Vec3d& p) {
        return (round * p - votes[at->second].a_T_b * p).norm() < kClose_m + kClosePerPath * longest_m;
      });
      if (!closes) continue;
      const std::size_t weakest =
          std::min({votes[i].members.size(), votes[bc->second].members.size(), votes[at->second].members.size()});
      for (const std::size_t vote : {i, bc->second, at->second}) out[vote] += weakest;
    }
  }
  return out;
}

}  // namespace

ChainStart StartAlongTree(const ChainGraph& graph, const std::vector<FrameVote>& votes) {
  const std::vector<std::size_t> support = Supports(graph, votes);
  std::vector<std::size_t> order(votes.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return support[x] > support[y]; });
  const auto chains = static_cast<std::size_t>(graph.chains());
  std::vector<Pose3> root_T_chain(chains);
  ChainStart out;
  out.root_of.assign(chains, -1);
  const auto grow = [&](std::size_t root) {
    out.root_of[root] = static_cast<int>(root);
    for (bool grown = true; grown;) {
      grown = false;
      for (const std::size_t i : order) {
        const FrameVote& vote = votes[i];
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
