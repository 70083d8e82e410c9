// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/chain_start.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace mapweld::merge {
namespace {

using geom::Pose3;

// Two loops of one pair of chains agree when they place the other chain within this of each other, where both are.
constexpr double kAgree_m = 4;
constexpr double kAgree_rad = 0.15;
constexpr double kDrift = 0.03;  // of the odometry between them, m per m

struct Proposal {
  int chain_a = 0;
  int chain_b = 0;
  Pose3 a_T_b;           // chain frames
  double support = 0;    // weight of the loops that agree, itself included
  bool trusted = false;  // by loops of weight above 0.5
};

Pose3 ChainTransform(const ChainGraph& graph, const GraphEdge& loop) {
  return graph.chain_T_node[static_cast<std::size_t>(loop.a)] * loop.a_T_b *
         graph.chain_T_node[static_cast<std::size_t>(loop.b)].Inverse();
}

bool Agree(const ChainGraph& graph, const GraphEdge& x, const GraphEdge& y) {
  const auto node = [&](int i) -> const Pose3& { return graph.chain_T_node[static_cast<std::size_t>(i)]; };
  const Pose3 predicted = node(y.a).Inverse() * ChainTransform(graph, x) * node(y.b);
  const Pose3 off = predicted.Inverse() * y.a_T_b;
  const double distance_m = (node(x.a).t - node(y.a).t).norm() + (node(x.b).t - node(y.b).t).norm();
  return off.t.norm() < kAgree_m + kDrift * distance_m && geom::LogSo3(off.q).norm() < kAgree_rad;
}

// The loop of a pair that most others agree with.
Proposal Propose(const ChainGraph& graph, const std::vector<std::size_t>& loops, const std::vector<double>& weight) {
  Proposal best;
  for (const std::size_t i : loops) {
    double support = 0;
    for (const std::size_t k : loops) {
      if (i == k || Agree(graph, graph.loops[i], graph.loops[k])) support += std::max(weight[k], 1e-6);
    }
    if (support > best.support) best = {0, 0, ChainTransform(graph, graph.loops[i]), support, weight[i] > 0.5};
  }
  return best;
}

}  // namespace

std::vector<Pose3> StartAlongTree(const ChainGraph& graph, const std::vector<double>& loop_weight) {
  int chains = 0;
  for (const int chain : graph.chain_of) chains = std::max(chains, chain + 1);
  const auto chain_of = [&](int node) { return graph.chain_of[static_cast<std::size_t>(node)]; };
  std::map<std::pair<int, int>, std::vector<std::size_t>> loops_of_pair;
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    const int a = chain_of(graph.loops[i].a);
    const int b = chain_of(graph.loops[i].b);
    if (a != b) loops_of_pair[{a, b}].push_back(i);
  }
  std::vector<Proposal> proposals;
  for (const auto& [pair, loops] : loops_of_pair) {
    Proposal proposal = Propose(graph, loops, loop_weight);
    proposal.chain_a = pair.first;
    proposal.chain_b = pair.second;
    proposals.push_back(proposal);
  }
  std::stable_sort(proposals.begin(), proposals.end(), [](const Proposal& x, const Proposal& y) {
    return x.trusted != y.trusted ? x.trusted : x.support > y.support;
  });

  std::vector<Pose3> world_T_chain(static_cast<std::size_t>(chains));
  std::vector<bool> placed(static_cast<std::size_t>(chains), false);
  placed[static_cast<std::size_t>(chain_of(graph.anchor))] = true;
  for (bool grown = true; grown;) {
    grown = false;
    for (const Proposal& p : proposals) {
      const auto a = static_cast<std::size_t>(p.chain_a);
      const auto b = static_cast<std::size_t>(p.chain_b);
      if (placed[a] == placed[b]) continue;
      if (placed[a]) world_T_chain[b] = world_T_chain[a] * p.a_T_b;
      if (placed[b]) world_T_chain[a] = world_T_chain[b] * p.a_T_b.Inverse();
      placed[a] = placed[b] = true;
      grown = true;
      break;
    }
  }
  std::vector<Pose3> start;
  for (std::size_t i = 0; i < graph.chain_T_node.size(); ++i) {
    start.push_back(world_T_chain[static_cast<std::size_t>(graph.chain_of[i])] * graph.chain_T_node[i]);
  }
  return start;
}

}  // namespace mapweld::merge
