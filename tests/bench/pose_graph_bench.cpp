// SPDX-License-Identifier: Apache-2.0
// The pose graph solver on standard graphs and on graphs of a city, beside Ceres where it is installed:
//   pose_graph_bench [--runs N] [--big] [--no-ceres] [--json FILE] [GRAPH.g2o ...]
// Every solver gets the same graph in the same run and is judged by our cost; CPU seconds are medians. Standard graphs
// are taken from ../shared/data/pose_graphs where they are there.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/bench/ceres_solve.hpp"
#include "tests/bench/city_graph.hpp"
#include "tests/support/shared_data.hpp"
#include "tools/io/atomic_file.hpp"
#include "tools/io/g2o.hpp"
#include "tools/pose_graph/graph_file.hpp"

namespace mapweld::bench {
namespace {

struct Subject {
  std::string name;
  pose_graph::PoseGraph graph;
};

struct Row {
  std::string graph;
  std::string solver;
  std::size_t poses = 0;
  std::size_t edges = 0;
  int iterations = 0;
  double cpu_s = 0;
  double cost = 0;
};

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Row Measure(const Subject& subject, const std::string& solver, int runs,
            const std::function<int(pose_graph::PoseGraph*)>& solve) {
  Row row{subject.name, solver, subject.graph.world_T_node.size(), subject.graph.edges.size()};
  std::vector<double> seconds;
  for (int run = 0; run < runs; ++run) {
    pose_graph::PoseGraph graph = subject.graph;
    const std::clock_t begin = std::clock();
    row.iterations = solve(&graph);
    seconds.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    row.cost = pose_graph::Cost(graph);
  }
  row.cpu_s = Median(seconds);
  fmt::print("{:<16} {:>7} {:>7}  {:<22} {:>4}  {:>8.3f}  {:>14.4f}\n", row.graph, row.poses, row.edges, row.solver,
             row.iterations, row.cpu_s, row.cost);
  std::fflush(stdout);
  return row;
}

std::vector<Subject> Subjects(const std::vector<std::string>& files, bool big) {
  std::vector<Subject> out;
  for (const char* name : {"sphere2500", "torus3D", "parking-garage"}) {
    const auto path = test::SharedData(fmt::format("pose_graphs/{}.g2o", name));
    if (path.has_value()) out.push_back({name, pose_graph::FromFile(io::ReadG2o(*path)).graph});
    if (!path.has_value()) fmt::print(stderr, "{}: not here, left out\n", name);
  }
  for (const std::string& file : files) {
    out.push_back({std::filesystem::path(file).stem().string(), pose_graph::FromFile(io::ReadG2o(file)).graph});
  }
  out.push_back({"city of 24k", MakeCity({}).graph});
  if (big) out.push_back({"city of 240k", MakeCity({500, 480, 190, 1}).graph});
  // Parts that hang together with nothing need a held pose each.
  for (Subject& subject : out) pose_graph::HoldEveryComponent(&subject.graph);
  return out;
}

void Run(int runs, bool big, bool with_ceres, const std::string& json, const std::vector<std::string>& files) {
  constexpr int kMaxIterations = 100;
  fmt::print("{:<16} {:>7} {:>7}  {:<22} {:>4}  {:>8}  {:>14}\n", "graph", "poses", "edges", "solver", "it.", "CPU s",
             "cost");
  std::vector<Row> rows;
  for (const Subject& subject : Subjects(files, big)) {
    const auto ours = [](pose_graph::Start start) {
      return [start](pose_graph::PoseGraph* graph) {
        pose_graph::SolveConfig config;
        config.max_iterations = kMaxIterations;
        config.start = start;
        return pose_graph::SolveComponents(graph, config).iterations;
      };
    };
    rows.push_back(Measure(subject, "Mapweld", runs, ours(pose_graph::Start::kBetter)));
    rows.push_back(Measure(subject, "Mapweld, given start", runs, ours(pose_graph::Start::kGiven)));
    if (!with_ceres || !kHaveCeres) continue;
    rows.push_back(Measure(subject, "Ceres, given start", runs,
                           [](pose_graph::PoseGraph* graph) { return SolveWithCeres(graph, kMaxIterations); }));
  }
  if (!kHaveCeres) fmt::print("Ceres was not there when this was built (package libceres-dev)\n");
  if (json.empty()) return;
  nlohmann::json out = nlohmann::json::array();
  for (const Row& row : rows) {
    out.push_back({{"graph", row.graph},
                   {"solver", row.solver},
                   {"poses", row.poses},
                   {"edges", row.edges},
                   {"iterations", row.iterations},
                   {"cpu_s", row.cpu_s},
                   {"cost", row.cost}});
  }
  io::AtomicFile file(json);
  file.Write(out.dump(1) + "\n");
  file.Commit();
}

}  // namespace
}  // namespace mapweld::bench

int main(int argc, char** argv) {
  CLI::App app("The pose graph solver beside Ceres");
  int runs = 3;
  bool big = false;
  bool no_ceres = false;
  std::string json;
  std::vector<std::string> files;
  app.add_option("graphs", files, "more g2o files");
  app.add_option("--runs", runs, "of every solver; the median counts")
      ->check(CLI::Range(1, 101))
      ->capture_default_str();
  app.add_flag("--big", big, "also a city of 240 000 poses");
  app.add_flag("--no-ceres", no_ceres, "only ours");
  app.add_option("--json", json, "file for the table");
  CLI11_PARSE(app, argc, argv);
  try {
    mapweld::bench::Run(runs, big, !no_ceres, json, files);
  } catch (const std::exception& error) {
    fmt::print(stderr, "pose_graph_bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
