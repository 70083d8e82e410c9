// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/robust_solve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tools/merge/chain_start.hpp"
#include "tools/merge/frame_vote.hpp"
#include "tools/pose_graph/graph_checks.hpp"
#include "tools/pose_graph/graph_pattern.hpp"
#include "tools/pose_graph/solve.hpp"

namespace mapweld::merge {
namespace {

using pose_graph::PoseGraph;

constexpr int kIterationsPerRound = 3;  // while weights still change
constexpr double kNothing = 1e-9;       // a weight that is nothing in effect

// One attempt: chains, the loops that may count, and the estimate as it becomes better.
class Attempt {
 public:
  // `usable`: per loop, whether it is a measurement at all. `votes`: those that may tie chains.
  Attempt(const ChainGraph& graph, const RobustConfig& config, const std::vector<bool>& usable,
          const std::vector<FrameVote>& votes)
      : graph_(graph), config_(config), usable_(usable), votes_(votes) {
    const ChainStart start = StartAlongTree(graph, votes);
    root_of_ = start.root_of;
    estimate_.world_T_node = start.world_T_node;
    estimate_.held = Held();
    estimate_.edges = graph.odometry;
    for (std::size_t i = 0; i < graph.loops.size(); ++i) {
      const pose_graph::Edge& loop = graph.loops[i];
      if (!usable_[i] || Root(loop.a) != Root(loop.b)) continue;
      counted_.push_back(i);
      estimate_.edges.push_back(loop);
    }
    weight_.assign(counted_.size(), 1.0);
    solver_.emplace(&estimate_);
  }
  Attempt(const Attempt&) = delete;
  Attempt& operator=(const Attempt&) = delete;

  void Run() {
    if (counted_.empty()) return;
    ChooseLoops();
    for (double& w : weight_) w = w > 0.5 ? 1.0 : 0.0;
    StartAgain();
    ScaleLoops();
  }

  // The pair of chains that fits the answer worst, of those that do not fit; the number of votes when all fit.
  [[nodiscard]] std::size_t WorstVote() const {
    const std::vector<double> chi2 = PerLoop([&](std::size_t k) { return LoopChi2(k); }, 0);
    const std::vector<double> weight = PerLoop([&](std::size_t k) { return weight_[k]; }, 0);
    std::size_t worst = votes_.size();
    double worst_chi2 = config_.inlier_chi2;
    for (std::size_t v = 0; v < votes_.size(); ++v) {
      double sum = 0;
      std::size_t kept = 0;
      for (const std::size_t loop : votes_[v].members) {
        sum += chi2[loop];
        kept += weight[loop] > 0.5 ? 1U : 0U;
      }
      const double mean = sum / static_cast<double>(votes_[v].members.size());
      if (2 * kept >= votes_[v].members.size() && mean <= config_.inlier_chi2) continue;
      if (worst < votes_.size() && mean <= worst_chi2) continue;
      worst = v;
      worst_chi2 = mean;
    }
    return worst;
  }

  [[nodiscard]] RobustResult Result() const {
    return {estimate_.world_T_node, root_of_, PerLoop([&](std::size_t k) { return weight_[k]; }, 0)};
  }

 private:
  [[nodiscard]] int Root(int node) const { return root_of_[static_cast<std::size_t>(graph_.ChainOf(node))]; }

  // The anchor, and the first node of every other root.
  [[nodiscard]] std::vector<int> Held() const {
    std::vector<int> out{graph_.anchor};
    for (int node = 0; node < static_cast<int>(graph_.chain_of.size()); ++node) {
      const int chain = graph_.ChainOf(node);
      const bool first = node == 0 || graph_.ChainOf(node - 1) != chain;
      if (first && Root(node) == chain && chain != graph_.ChainOf(graph_.anchor)) out.push_back(node);
    }
    return out;
  }

  [[nodiscard]] double LoopChi2(std::size_t k) const {
    return pose_graph::Chi2(estimate_.world_T_node, graph_.loops[counted_[k]]);
  }

  template <class Value>
  [[nodiscard]] std::vector<double> PerLoop(const Value& value, double otherwise) const {
    std::vector<double> out(graph_.loops.size(), otherwise);
    for (std::size_t k = 0; k < counted_.size(); ++k) out[counted_[k]] = value(k);
    return out;
  }

  // A weight of exactly zero could cut the graph apart.
  void Solve(int iterations) {
    for (std::size_t k = 0; k < counted_.size(); ++k) {
      estimate_.edges[graph_.odometry.size() + k].weight = std::max(weight_[k], kNothing);
    }
    pose_graph::SolveConfig config;
    config.max_iterations = iterations;
    (void)solver_->Run(config);
  }

  // Truncated least squares by graduated non-convexity: weights go to 0 or 1 as mu grows.
  void ChooseLoops() {
    double greatest = 0;
    for (std::size_t k = 0; k < counted_.size(); ++k) greatest = std::max(greatest, LoopChi2(k));
    const double c2 = config_.inlier_chi2;
    double mu = greatest > c2 ? std::max(c2 / (2 * greatest - c2), 1e-4) : 1e3;
    for (int round = 0; round < config_.gnc_rounds; ++round, mu *= 1.8) {
      bool binary = true;
      for (std::size_t k = 0; k < counted_.size(); ++k) {
        const double chi2 = LoopChi2(k);
        double w = 0;
        if (chi2 <= mu / (mu + 1) * c2) {
          w = 1;
        } else if (chi2 < (mu + 1) / mu * c2) {
          w = std::clamp(std::sqrt(c2 * mu * (mu + 1) / chi2) - mu, 0.0, 1.0);
        }
        binary = binary && (w < 0.01 || w > 0.99);
        weight_[k] = w;
      }
      Solve(kIterationsPerRound);
      if (binary && round > 2) break;
    }
    Solve(config_.max_iterations);
  }

  // From a tree of the chosen loops: where choosing ended may be a wrong minimum of the right loops.
  void StartAgain() {
    std::vector<FrameVote> chosen = VoteOnFrames(graph_, PerLoop([&](std::size_t k) { return weight_[k]; }, 0));
    // Pairs of which no loop was chosen still tie what nothing else does.
    for (const FrameVote& vote : votes_) {
      const bool known = std::any_of(chosen.begin(), chosen.end(), [&](const FrameVote& other) {
        return other.chain_a == vote.chain_a && other.chain_b == vote.chain_b;
      });
      if (known) continue;
      chosen.push_back(vote);
      chosen.back().members.resize(1);
    }
    estimate_.world_T_node = StartAlongTree(graph_, chosen).world_T_node;
    Solve(config_.max_iterations);
  }

  // Dynamic covariance scaling over all loops, to a standstill.
  void ScaleLoops() {
    constexpr int kRounds = 40;
    for (int round = 0; round < kRounds; ++round) {
      double change = 0;
      for (std::size_t k = 0; k < counted_.size(); ++k) {
        const double s = std::min(1.0, 2 * config_.dcs_phi / (config_.dcs_phi + LoopChi2(k)));
        change = std::max(change, std::abs(weight_[k] - s * s));
        weight_[k] = s * s;
      }
      if (round > 0 && change < 1e-3) break;
      Solve(kIterationsPerRound);
    }
    Solve(config_.max_iterations);
  }

  const ChainGraph& graph_;
  const RobustConfig& config_;
  const std::vector<bool>& usable_;
  const std::vector<FrameVote>& votes_;
  std::vector<int> root_of_;
  std::vector<std::size_t> counted_;  // loops within one connected part, in the order of the estimate's last edges
  PoseGraph estimate_;
  std::optional<pose_graph::Solver> solver_;  // of the estimate
  std::vector<double> weight_;                // per counted loop
};

}  // namespace

RobustResult SolveRobust(const ChainGraph& graph, const RobustConfig& config) {
  // Loops in an order of their own: the result must not depend on how they were listed.
  const std::vector<std::size_t> order = pose_graph::OrderOfEdges(graph.loops);
  ChainGraph sorted = graph;
  for (std::size_t i = 0; i < order.size(); ++i) sorted.loops[i] = graph.loops[order[i]];

  const int nodes = static_cast<int>(graph.chain_T_node.size());
  std::vector<bool> usable;
  std::vector<double> weight;
  for (const pose_graph::Edge& loop : sorted.loops) {
    usable.push_back(pose_graph::FaultOf(loop, nodes).empty());
    weight.push_back(usable.back() ? 1 : 0);
  }
  std::vector<FrameVote> votes = VoteOnFrames(sorted, weight);
  std::erase_if(votes, [&](const FrameVote& vote) { return vote.places < config.min_places; });
  for (;;) {
    Attempt attempt(sorted, config, usable, votes);
    attempt.Run();
    const std::size_t worst = attempt.WorstVote();
    if (worst < votes.size()) {
      votes.erase(votes.begin() + static_cast<std::ptrdiff_t>(worst));
      continue;
    }
    RobustResult out = attempt.Result();
    const std::vector<double> by_order = out.loop_weight;
    for (std::size_t i = 0; i < order.size(); ++i) out.loop_weight[order[i]] = by_order[i];
    return out;
  }
}

}  // namespace mapweld::merge
