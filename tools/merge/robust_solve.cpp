// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/robust_solve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/merge/chain_start.hpp"

namespace mapweld::merge {
namespace {

PoseGraph Assemble(const ChainGraph& graph, const std::vector<double>& loop_weight, std::vector<geom::Pose3> start) {
  PoseGraph out;
  out.world_T_node = std::move(start);
  out.anchor = graph.anchor;
  out.edges = graph.odometry;
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    out.edges.push_back(graph.loops[i]);
    out.edges.back().weight = loop_weight[i];
  }
  return out;
}

// Reads the chi2 of every loop at the present estimate.
std::vector<double> LoopChi2(const ChainGraph& graph, const PoseGraph& solved) {
  std::vector<double> out;
  for (const GraphEdge& loop : graph.loops) out.push_back(Chi2(solved, loop));
  return out;
}

// A weight of exactly zero could cut the graph apart; this is nothing in effect.
double Held(double weight) {
  return std::max(weight, 1e-9);
}

// Truncated least squares by graduated non-convexity: weights go to 0 or 1 as mu grows.
std::vector<double> ChooseLoops(const ChainGraph& graph, const RobustConfig& config, PoseGraph* pose_graph) {
  std::vector<double> weight(graph.loops.size(), 1.0);
  std::vector<double> chi2 = LoopChi2(graph, *pose_graph);
  double greatest = 0;
  for (const double x : chi2) greatest = std::max(greatest, x);
  const double c2 = config.inlier_chi2;
  double mu = greatest > c2 ? c2 / std::max(2 * greatest - c2, 1e-9) : 1e3;
  mu = std::max(mu, 1e-4);
  for (int round = 0; round < config.gnc_rounds; ++round) {
    bool binary = true;
    for (std::size_t i = 0; i < weight.size(); ++i) {
      const double low = mu / (mu + 1) * c2;
      const double high = (mu + 1) / mu * c2;
      double w = 0;
      if (chi2[i] <= low) {
        w = 1;
      } else if (chi2[i] < high) {
        w = std::clamp(std::sqrt(c2 * mu * (mu + 1) / chi2[i]) - mu, 0.0, 1.0);
      }
      binary = binary && (w < 0.01 || w > 0.99);
      weight[i] = w;
    }
    for (std::size_t i = 0; i < weight.size(); ++i)
      pose_graph->edges[graph.odometry.size() + i].weight = Held(weight[i]);
    (void)Solve(pose_graph, config.max_iterations);
    chi2 = LoopChi2(graph, *pose_graph);
    if (binary && round > 2) break;
    mu *= 1.8;
  }
  return weight;
}

// Dynamic covariance scaling over all loops, to a standstill.
std::vector<double> ScaleLoops(const ChainGraph& graph, const RobustConfig& config, PoseGraph* pose_graph) {
  constexpr int kRounds = 15;
  std::vector<double> weight(graph.loops.size(), 1.0);
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<double> chi2 = LoopChi2(graph, *pose_graph);
    double change = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
      const double s = std::min(1.0, 2 * config.dcs_phi / (config.dcs_phi + chi2[i]));
      change = std::max(change, std::abs(weight[i] - s * s));
      weight[i] = s * s;
      pose_graph->edges[graph.odometry.size() + i].weight = Held(weight[i]);
    }
    (void)Solve(pose_graph, config.max_iterations);
    if (change < 1e-3) break;
  }
  return weight;
}

}  // namespace

RobustResult SolveRobust(const ChainGraph& graph, const RobustConfig& config) {
  std::vector<double> weight(graph.loops.size(), 1.0);
  PoseGraph pose_graph = Assemble(graph, weight, StartAlongTree(graph, weight));
  CheckGraph(pose_graph);
  weight = ChooseLoops(graph, config, &pose_graph);
  for (double& w : weight) w = w > 0.5 ? 1.0 : 0.0;
  PoseGraph fresh = Assemble(graph, weight, StartAlongTree(graph, weight));
  for (std::size_t i = 0; i < weight.size(); ++i) fresh.edges[graph.odometry.size() + i].weight = Held(weight[i]);
  (void)Solve(&fresh, config.max_iterations);
  RobustResult out;
  out.loop_weight = ScaleLoops(graph, config, &fresh);
  out.world_T_node = std::move(fresh.world_T_node);
  return out;
}

}  // namespace mapweld::merge
