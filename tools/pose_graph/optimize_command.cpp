// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/optimize_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "tools/io/atomic_file.hpp"
#include "tools/pose_graph/graph_file.hpp"
#include "tools/pose_graph/marginals.hpp"

namespace mapweld::pose_graph {
namespace {

struct OptimizeArguments {
  std::filesystem::path in;
  std::filesystem::path out;
  std::filesystem::path covariance;
  std::string start = "better";
  SolveConfig config;
};

// One row per pose: its number and the upper triangle of its covariance.
void WriteCovariances(const std::filesystem::path& path, const LoadedGraph& loaded) {
  const Marginals marginals(&loaded.graph);
  io::AtomicFile file(path);
  file.Write(
      "# id, then the upper triangle of the 6 x 6 covariance (x y z in m, rotation vector in rad, frame of the "
      "pose)\n");
  for (std::size_t i = 0; i < loaded.id.size(); ++i) {
    const geom::Mat6d covariance = marginals.OfNode(static_cast<int>(i));
    std::string row = fmt::format("{}", loaded.id[i]);
    for (Eigen::Index r = 0; r < 6; ++r) {
      for (Eigen::Index c = r; c < 6; ++c) row += fmt::format(" {:.6g}", covariance(r, c));
    }
    file.Write(row += '\n');
  }
  file.Commit();
}

void RunOptimize(const OptimizeArguments& arguments) {
  constexpr std::size_t kNamed = 10;
  const io::PoseGraphFile file = io::ReadG2o(arguments.in);
  LoadedGraph loaded = FromFile(file);
  if (loaded.graph.world_T_node.empty()) {
    throw std::runtime_error(
        fmt::format("{} holds no pose graph: no VERTEX_SE3:QUAT and no EDGE_SE3:QUAT", arguments.in.string()));
  }
  for (std::size_t i = 0; i < std::min(kNamed, loaded.refused.size()); ++i) {
    fmt::print(stderr, "optimize: {}: {}; left out\n", arguments.in.string(), loaded.refused[i]);
  }
  if (loaded.refused.size() > kNamed) {
    fmt::print(stderr, "optimize: {}: {} more edges left out\n", arguments.in.string(), loaded.refused.size() - kNamed);
  }
  SolveConfig config = arguments.config;
  config.start = arguments.start == "given" ? Start::kGiven : Start::kBetter;
  const std::clock_t begin = std::clock();
  const ComponentsReport report = SolveComponents(&loaded.graph, config);
  const double cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  io::WriteG2o(arguments.out, ToFile(loaded, file));
  if (!arguments.covariance.empty()) WriteCovariances(arguments.covariance, loaded);
  std::string remarks;
  if (!loaded.refused.empty()) remarks += fmt::format(", {} edges left out", loaded.refused.size());
  if (report.components > 1) {
    remarks += fmt::format(", {} unconnected parts, each in a frame of its own", report.components);
  }
  if (report.chordal > 0) remarks += ", chordal start";
  if (report.not_converged > 0) remarks += ", NOT CONVERGED: raise --max-iterations";
  fmt::print("{} poses, {} edges: cost {:.6g} -> {:.6g} in {} iterations, {:.2f} s of CPU{}\n", loaded.id.size(),
             loaded.graph.edges.size(), report.cost_before, report.cost_after, report.iterations, cpu_s, remarks);
}

}  // namespace

void AddOptimizeCommand(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("optimize", "Optimise a pose graph in a g2o file");
  const auto arguments = std::make_shared<OptimizeArguments>();
  command->add_option("graph", arguments->in, "g2o file with VERTEX_SE3:QUAT and EDGE_SE3:QUAT")->required();
  command->add_option("-o,--out", arguments->out, "g2o file for the optimised poses")->required();
  command
      ->add_option("--start", arguments->start,
                   "given: from the poses in the file; better: from these or a chordal start, whichever costs less")
      ->check(CLI::IsMember({"given", "better"}))
      ->capture_default_str();
  command->add_option("--covariance", arguments->covariance, "text file for the covariance of every pose");
  command->add_option("--max-iterations", arguments->config.max_iterations, "at most this many, per connected part")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->callback([arguments] { RunOptimize(*arguments); });
}

}  // namespace mapweld::pose_graph
