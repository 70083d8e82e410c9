// SPDX-License-Identifier: Apache-2.0
// Wrong loops in the pose graph of three vehicles: the robust solver beside plain least squares, Huber and DCS alone.
//   robust_bench [--seeds N] [--json FILE]; tests/bench/plot_robust.py FILE OUT.png draws it.
// Worst and mean over the seeds: error after one alignment of all vehicles, against that of the same graph without
// wrong loops; share of the accepted loops (weight above 0.5) that are true, share of the true loops accepted.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/bench/fleet_graph.hpp"
#include "tools/io/atomic_file.hpp"
#include "tools/merge/robust_solve.hpp"
#include "tools/pose_graph/solve.hpp"

namespace mapweld::bench {
namespace {

struct Answer {
  std::vector<geom::Pose3> poses;
  std::vector<double> loop_weight;
};

using Solver = std::function<Answer(const merge::ChainGraph&)>;

// Iteratively re-weighted least squares from the frames as they are.
Answer Reweighted(const merge::ChainGraph& graph, const std::function<double(double chi2)>& weight_of) {
  constexpr int kRounds = 25;
  pose_graph::PoseGraph pose_graph;
  pose_graph.world_T_node = graph.chain_T_node;
  pose_graph.held = {graph.anchor};
  pose_graph.edges = graph.odometry;
  pose_graph.edges.insert(pose_graph.edges.end(), graph.loops.begin(), graph.loops.end());
  pose_graph::SolveConfig config;
  config.max_iterations = 3;
  Answer out;
  out.loop_weight.assign(graph.loops.size(), 1);
  double cost = -1;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < graph.loops.size(); ++i) {
      out.loop_weight[i] = weight_of(pose_graph::Chi2(pose_graph.world_T_node, graph.loops[i]));
      pose_graph.edges[graph.odometry.size() + i].weight = std::max(out.loop_weight[i], 1e-9);
    }
    const double now = pose_graph::Solve(&pose_graph, config).cost_after;
    if (std::abs(now - cost) < 1e-6 * now) break;
    cost = now;
  }
  out.poses = pose_graph.world_T_node;
  return out;
}

struct Method {
  std::string name;
  Solver solve;
};

std::vector<Method> Methods() {
  const auto reweighted = [](std::function<double(double)> weight) {
    return [weight](const merge::ChainGraph& graph) { return Reweighted(graph, weight); };
  };
  return {
      {"Mapweld",
       [](const merge::ChainGraph& graph) {
         merge::RobustResult result = merge::SolveRobust(graph, {});
         return Answer{std::move(result.world_T_node), std::move(result.loop_weight)};
       }},
      {"least squares", reweighted([](double) { return 1.0; })},
      {"Huber", reweighted([](double chi2) { return chi2 <= 4 ? 1.0 : 2 / std::sqrt(chi2); })},
      {"DCS alone", reweighted([](double chi2) {
         const double s = std::min(1.0, 2 * 15 / (15 + chi2));
         return s * s;
       })},
  };
}

struct Scenario {
  std::string name;
  bool known_frames;
  int wrong_group;
  bool peers;
};

struct Row {
  std::string scenario;
  std::string method;
  double wrong_share = 0;
  double mean_ratio = 0;  // error / error of ours without wrong loops
  double worst_ratio = 0;
  double mean_error_m = 0;
  double precision = 0;
  double recall = 0;
  int good = 0;  // seeds with a ratio up to 1.2
};

Row Measure(const Scenario& scenario, const Method& method, double wrong_share, int seeds,
            const std::vector<double>& clean_m) {
  Row row{scenario.name, method.name, wrong_share};
  int accepted_true = 0;
  int accepted = 0;
  int all_true = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    FleetConfig config;
    config.known_frames = scenario.known_frames;
    config.wrong_group = scenario.wrong_group;
    config.wrong_share = wrong_share;
    config.seed = static_cast<unsigned>(seed);
    const FleetGraph fleet = MakeFleet(config);
    const Answer answer = method.solve(fleet.graph);
    const double error_m = AbsoluteError(answer.poses, fleet.truth);
    const double ratio = error_m / clean_m[static_cast<std::size_t>(seed - 1)];
    row.mean_error_m += error_m / seeds;
    row.mean_ratio += ratio / seeds;
    row.worst_ratio = std::max(row.worst_ratio, ratio);
    row.good += ratio <= 1.2 ? 1 : 0;
    for (std::size_t i = 0; i < fleet.is_true.size(); ++i) {
      all_true += fleet.is_true[i] ? 1 : 0;
      if (answer.loop_weight[i] <= 0.5) continue;
      ++accepted;
      accepted_true += fleet.is_true[i] ? 1 : 0;
    }
  }
  row.precision = accepted > 0 ? static_cast<double>(accepted_true) / accepted : 1;
  row.recall = static_cast<double>(accepted_true) / all_true;
  fmt::print("{:<22} {:>5.0f} %  {:<14} {:>9.2f} {:>8.2f} {:>8.2f} {:>5}/{:<3} {:>9.4f} {:>7.3f}\n", row.scenario,
             100 * wrong_share, row.method, row.mean_error_m, row.mean_ratio, row.worst_ratio, row.good, seeds,
             row.precision, row.recall);
  std::fflush(stdout);
  return row;
}

void Run(int seeds, const std::string& json) {
  const std::vector<Scenario> scenarios = {{"known frames", true, 1, true},
                                           {"unknown frames", false, 1, true},
                                           {"unknown, groups of 3", false, 3, false},
                                           {"unknown, groups of 5", false, 5, false},
                                           {"unknown, groups of 10", false, 10, false},
                                           {"unknown, groups of 20", false, 20, false}};
  std::vector<Row> rows;
  fmt::print("{:<22} {:>7}  {:<14} {:>9} {:>8} {:>8} {:>9} {:>9} {:>7}\n", "scenario", "wrong", "method", "error m",
             "mean x", "worst x", "<= 1.2 x", "precision", "recall");
  for (const Scenario& scenario : scenarios) {
    std::vector<double> clean_m;
    for (int seed = 1; seed <= seeds; ++seed) {
      FleetConfig config;
      config.known_frames = scenario.known_frames;
      config.seed = static_cast<unsigned>(seed);
      const FleetGraph fleet = MakeFleet(config);
      clean_m.push_back(AbsoluteError(merge::SolveRobust(fleet.graph, {}).world_T_node, fleet.truth));
    }
    for (const double wrong_share : {0.0, 0.01, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}) {
      for (const Method& method : Methods()) {
        if (method.name != "Mapweld" && !scenario.peers) continue;
        rows.push_back(Measure(scenario, method, wrong_share, seeds, clean_m));
      }
    }
  }
  if (json.empty()) return;
  nlohmann::json out = nlohmann::json::array();
  for (const Row& row : rows) {
    out.push_back({{"scenario", row.scenario},
                   {"method", row.method},
                   {"wrong_share", row.wrong_share},
                   {"mean_error_m", row.mean_error_m},
                   {"mean_ratio", row.mean_ratio},
                   {"worst_ratio", row.worst_ratio},
                   {"good", row.good},
                   {"seeds", seeds},
                   {"precision", row.precision},
                   {"recall", row.recall}});
  }
  io::WriteFileAtomically(json, out.dump(1) + "\n");
}

}  // namespace
}  // namespace mapweld::bench

int main(int argc, char** argv) {
  CLI::App app("Wrong loops in a pose graph: the robust solver beside others");
  int seeds = 20;
  std::string json;
  app.add_option("--seeds", seeds, "graphs per row")->check(CLI::Range(1, 10000))->capture_default_str();
  app.add_option("--json", json, "file for the table");
  CLI11_PARSE(app, argc, argv);
  try {
    mapweld::bench::Run(seeds, json);
  } catch (const std::exception& error) {
    fmt::print(stderr, "robust_bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
