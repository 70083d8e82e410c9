// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/solve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tools/pose_graph/chordal_start.hpp"
#include "tools/pose_graph/graph_checks.hpp"

namespace mapweld::pose_graph {
namespace {

using geom::Pose3;

constexpr double kSmallStep = 1e-6;  // m and rad: converged
constexpr double kFirstDamping = 1e-4;
constexpr double kLeastDamping = 1e-6;  // below, none
constexpr double kGreatestDamping = 1e10;

// The chordal start, refined by nothing yet, where it costs less than the given one.
bool TakeBetterStart(const GraphPattern& pattern, PoseGraph* graph) {
  std::optional<std::vector<Pose3>> start = ChordalStart(*graph, pattern);
  if (!start.has_value()) return false;
  const double given = Cost(*graph);
  std::swap(graph->world_T_node, *start);
  if (Cost(*graph) < given) return true;
  std::swap(graph->world_T_node, *start);
  return false;
}

}  // namespace

Solver::Solver(PoseGraph* graph)
    : graph_((CheckGraph(*graph), graph)), pattern_(PatternOf(*graph)), equations_(graph, &pattern_) {}

SolveReport Solver::Run(const SolveConfig& config) {
  SolveReport report;
  report.cost_before = Cost(*graph_);
  if (config.start == Start::kBetter) report.chordal = TakeBetterStart(pattern_, graph_);
  report.cost_after = equations_.Linearize(graph_->world_T_node);
  report.converged = pattern_.blocks.columns() == 0;
  std::vector<Pose3> tried(graph_->world_T_node.size());
  double damping = 0;
  while (!report.converged && report.iterations < config.max_iterations && damping <= kGreatestDamping) {
    ++report.iterations;
    bool better = false;
    if (equations_.Solve(damping)) {
      for (std::size_t i = 0; i < tried.size(); ++i) {
        const Pose3& now = graph_->world_T_node[i];
        tried[i] = pattern_.column[i] < 0 ? now : geom::Retract(now, equations_.Step(static_cast<int>(i)));
      }
      const double cost = equations_.Linearize(tried);
      const double decrease = report.cost_after - cost;
      better = std::isfinite(cost) && decrease >= 0;
      report.converged = equations_.LargestStep() < kSmallStep ||
                         (better && damping <= kFirstDamping && decrease <= config.small_decrease * cost);
      if (better) {
        std::swap(graph_->world_T_node, tried);
        report.cost_after = cost;
      }
    }
    if (better) {
      damping = damping > kLeastDamping ? 0.1 * damping : 0;
    } else {
      damping = std::max(10 * damping, kFirstDamping);
      if (!report.converged) (void)equations_.Linearize(graph_->world_T_node);
    }
  }
  return report;
}

SolveReport Solve(PoseGraph* graph, const SolveConfig& config) {
  return Solver(graph).Run(config);
}

}  // namespace mapweld::pose_graph
