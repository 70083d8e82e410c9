// SPDX-License-Identifier: Apache-2.0
// Least squares over SE(3) poses: Gauss-Newton, with damping (Levenberg-Marquardt) where a step does not help.
#pragma once

#include "tools/pose_graph/graph_pattern.hpp"
#include "tools/pose_graph/normal_equations.hpp"
#include "tools/pose_graph/pose_graph.hpp"

namespace mapweld::pose_graph {

enum class Start {
  kGiven,   // the poses in the graph
  kBetter,  // these or the chordal start, whichever costs less
};

struct SolveConfig {
  int max_iterations = 50;
  double small_decrease = 1e-7;  // of the cost, relative: converged
  Start start = Start::kGiven;
};

struct SolveReport {
  int iterations = 0;  // factorisations
  bool converged = false;
  bool chordal = false;  // started there
  double cost_before = 0;
  double cost_after = 0;
};

// For graphs that are solved again with other weights or from other starts: checks and analysis are done once.
class Solver {
 public:
  // Checks (CheckGraph, throws). The graph must outlive this and keep its nodes, held nodes and edges, but for weights.
  explicit Solver(PoseGraph* graph);
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  // Moves all nodes but the held ones. Never ends with a higher cost than it began with, or with a pose that is not
  // finite. The order in which edges are listed does not change a bit of the result. Cost per iteration: about 1
  // microsecond per node in a chain, plus a sparse factorisation over the nodes with three and more neighbours.
  SolveReport Run(const SolveConfig& config);

 private:
  PoseGraph* graph_;
  GraphPattern pattern_;
  NormalEquations equations_;
};

// Once.
SolveReport Solve(PoseGraph* graph, const SolveConfig& config);

}  // namespace mapweld::pose_graph
