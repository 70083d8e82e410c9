// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/frame_vote.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <utility>

namespace mapweld::merge {
namespace {

using geom::Pose3;

constexpr double kPlace_m = 10;
constexpr double kGate = 16.3;    // chi-square of 3 degrees of freedom, 99.9 %
constexpr double kSlack_m = 0.5;  // added to the gate: odometry is not quite what its sigmas say
constexpr double kSlack_rad = 0.02;

// What odometry has gathered since the chain began.
struct Gathered {
  double path_m = 0;
  double variance_m2 = 0;    // per axis
  double variance_rad2 = 0;  // per axis
};

double Variance(const geom::Mat6d& information, Eigen::Index first) {
  return 1 / std::max(information.diagonal().segment<3>(first).minCoeff(), 1e-12);
}

std::vector<Gathered> Gather(const ChainGraph& graph) {
  std::vector<Gathered> out(graph.chain_T_node.size());
  for (const pose_graph::Edge& edge : graph.odometry) {
    Gathered& own = out[static_cast<std::size_t>(edge.b)];
    own.path_m = edge.a_T_b.t.norm();
    own.variance_m2 = Variance(edge.information, 0);
    own.variance_rad2 = Variance(edge.information, 3);
  }
  for (std::size_t i = 1; i < out.size(); ++i) {
    if (graph.chain_of[i] != graph.chain_of[i - 1]) continue;
    out[i].path_m += out[i - 1].path_m;
    out[i].variance_m2 += out[i - 1].variance_m2;
    out[i].variance_rad2 += out[i - 1].variance_rad2;
  }
  return out;
}

// A loop seen from the chain with the lower number.
struct SeenLoop {
  std::size_t index = 0;
  int node_a = 0;
  int node_b = 0;
  Pose3 a_T_b;        // nodes
  Pose3 chain_a_T_b;  // chain frames
  double variance_m2 = 0;
  double variance_rad2 = 0;
};

class Voter {
 public:
  explicit Voter(const ChainGraph& graph) : graph_(graph), gathered_(Gather(graph)) {}

  [[nodiscard]] SeenLoop See(std::size_t index) const {
    const pose_graph::Edge& loop = graph_.loops[index];
    SeenLoop out{index, loop.a, loop.b, loop.a_T_b, {}, Variance(loop.information, 0), Variance(loop.information, 3)};
    if (graph_.ChainOf(loop.a) > graph_.ChainOf(loop.b)) {
      std::swap(out.node_a, out.node_b);
      out.a_T_b = loop.a_T_b.Inverse();
    }
    out.chain_a_T_b = Node(out.node_a) * out.a_T_b * Node(out.node_b).Inverse();
    return out;
  }

  [[nodiscard]] FrameVote Vote(const std::vector<SeenLoop>& loops) const {
    const std::size_t n = loops.size();
    std::vector<std::vector<bool>> agree(n, std::vector<bool>(n, true));
    std::vector<int> support(n, 1);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        agree[i][k] = agree[k][i] = Agree(loops[i], loops[k]) && Agree(loops[k], loops[i]);
        support[i] += agree[i][k] ? 1 : 0;
        support[k] += agree[i][k] ? 1 : 0;
      }
    }
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return support[x] > support[y]; });
    std::vector<std::size_t> set;
    for (const std::size_t i : order) {
      if (std::all_of(set.begin(), set.end(), [&](std::size_t k) { return agree[i][k]; })) set.push_back(i);
    }
    FrameVote out;
    out.chain_a = graph_.ChainOf(loops.front().node_a);
    out.chain_b = graph_.ChainOf(loops.front().node_b);
    out.a_T_b = loops[set.front()].chain_a_T_b;
    out.places = Places(loops, set);
    for (const std::size_t i : set) out.members.push_back(loops[i].index);
    std::sort(out.members.begin(), out.members.end());
    return out;
  }

 private:
  [[nodiscard]] const Pose3& Node(int node) const { return graph_.chain_T_node[static_cast<std::size_t>(node)]; }
  [[nodiscard]] const Gathered& Of(int node) const { return gathered_[static_cast<std::size_t>(node)]; }

  // Whether x, carried along both chains, says what y says.
  [[nodiscard]] bool Agree(const SeenLoop& x, const SeenLoop& y) const {
    const Pose3 predicted = Node(y.node_a).Inverse() * x.chain_a_T_b * Node(y.node_b);
    const Pose3 off = predicted.Inverse() * y.a_T_b;
    double variance_m2 = x.variance_m2 + y.variance_m2;
    double turn_rad2 = 0;
    for (const auto& [from, to] : {std::pair(x.node_a, y.node_a), std::pair(x.node_b, y.node_b)}) {
      variance_m2 += std::abs(Of(to).variance_m2 - Of(from).variance_m2);
      turn_rad2 += std::abs(Of(to).variance_rad2 - Of(from).variance_rad2);
    }
    // A turn at x moves y by the distance between them; a turn that grows on the way, by a third of that in variance.
    const double lever_m2 = std::max((Node(y.node_a).t - Node(x.node_a).t).squaredNorm(),
                                     (Node(y.node_b).t - Node(x.node_b).t).squaredNorm());
    variance_m2 += lever_m2 * (x.variance_rad2 + turn_rad2 / 3);
    const double variance_rad2 = x.variance_rad2 + y.variance_rad2 + turn_rad2;
    return off.t.norm() < kSlack_m + std::sqrt(kGate * variance_m2) &&
           geom::LogSo3(off.q).norm() < kSlack_rad + std::sqrt(kGate * variance_rad2);
  }

  [[nodiscard]] int Places(const std::vector<SeenLoop>& loops, const std::vector<std::size_t>& set) const {
    std::vector<std::size_t> kept;
    for (const std::size_t i : set) {
      const bool apart = std::all_of(kept.begin(), kept.end(), [&](std::size_t k) {
        return std::abs(Of(loops[i].node_a).path_m - Of(loops[k].node_a).path_m) >= kPlace_m &&
               std::abs(Of(loops[i].node_b).path_m - Of(loops[k].node_b).path_m) >= kPlace_m;
      });
      if (apart) kept.push_back(i);
    }
    return static_cast<int>(kept.size());
  }

  const ChainGraph& graph_;
  std::vector<Gathered> gathered_;
};

}  // namespace

std::vector<FrameVote> VoteOnFrames(const ChainGraph& graph, const std::vector<double>& loop_weight) {
  const Voter voter(graph);
  std::map<std::pair<int, int>, std::vector<SeenLoop>> pairs;
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    if (!(loop_weight[i] > 0.5)) continue;
    const std::pair<int, int> chains = std::minmax(graph.ChainOf(graph.loops[i].a), graph.ChainOf(graph.loops[i].b));
    if (chains.first != chains.second) pairs[chains].push_back(voter.See(i));
  }
  std::vector<FrameVote> out;
  for (const auto& [chains, loops] : pairs) out.push_back(voter.Vote(loops));
  return out;
}

}  // namespace mapweld::merge
