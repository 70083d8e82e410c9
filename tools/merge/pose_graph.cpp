// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/pose_graph.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace mapweld::merge {
namespace {

using geom::Mat6d;
using geom::Pose3;
using geom::Vec6d;

constexpr double kSmallStep = 1e-6;      // m and rad: converged
constexpr double kSmallDecrease = 1e-7;  // of chi2, relative: converged
constexpr double kFirstDamping = 1e-6;
constexpr double kGreatestDamping = 1e8;

double TotalChi2(const PoseGraph& graph) {
  double sum = 0;
  for (const GraphEdge& edge : graph.edges) sum += edge.weight * Chi2(graph, edge);
  return sum;
}

// The normal equations in blocks of 6. The anchor has no column: node i sits at 6 * (i - (i > anchor)).
class NormalEquations {
 public:
  explicit NormalEquations(const PoseGraph& graph) : graph_(&graph) {
    const auto n = static_cast<Eigen::Index>(6 * (graph.world_T_node.size() - 1));
    h_.resize(n, n);
    g_.resize(n);
  }

  void Linearize() {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(graph_->edges.size() * 4 * 36);
    g_.setZero();
    for (const GraphEdge& edge : graph_->edges) {
      const geom::BetweenLinearization l = geom::LinearizeBetween(Node(edge.a), Node(edge.b), edge.a_T_b);
      const Vec6d information = edge.weight * edge.sigma.array().square().inverse();
      const Mat6d wa = information.asDiagonal() * l.jacobian_a;
      const Mat6d wb = information.asDiagonal() * l.jacobian_b;
      const int a = Column(edge.a);
      const int b = Column(edge.b);
      AddBlock(a, a, l.jacobian_a.transpose() * wa, &entries);
      AddBlock(b, b, l.jacobian_b.transpose() * wb, &entries);
      AddBlock(std::max(a, b), std::min(a, b),
               a > b ? Mat6d(wa.transpose() * l.jacobian_b) : Mat6d(wb.transpose() * l.jacobian_a), &entries);
      if (a >= 0) g_.segment<6>(a) += wa.transpose() * l.residual;
      if (b >= 0) g_.segment<6>(b) += wb.transpose() * l.residual;
    }
    h_.setFromTriplets(entries.begin(), entries.end());
    if (!analysed_) solver_.analyzePattern(h_);
    analysed_ = true;
  }

  // False when the factorisation fails or the step is not finite.
  bool Step(double damping, Eigen::VectorXd* step) {
    Eigen::SparseMatrix<double> damped = h_;
    for (Eigen::Index i = 0; i < damped.rows(); ++i) damped.coeffRef(i, i) *= 1 + damping;
    solver_.factorize(damped);
    if (solver_.info() != Eigen::Success) return false;
    *step = solver_.solve(-g_);
    return step->allFinite();
  }

  [[nodiscard]] int Column(int node) const {
    if (node == graph_->anchor) return -1;
    return 6 * (node > graph_->anchor ? node - 1 : node);
  }

 private:
  [[nodiscard]] const Pose3& Node(int i) const { return graph_->world_T_node[static_cast<std::size_t>(i)]; }
  // Lower triangle only.
  static void AddBlock(int row, int col, const Mat6d& block, std::vector<Eigen::Triplet<double>>* entries) {
    if (row < 0 || col < 0) return;
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 6; ++k) {
        if (row != col || i >= k) entries->emplace_back(row + i, col + k, block(i, k));
      }
    }
  }

  const PoseGraph* graph_;
  Eigen::SparseMatrix<double> h_;
  Eigen::VectorXd g_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  bool analysed_ = false;
};

}  // namespace

double Chi2(const PoseGraph& graph, const GraphEdge& edge) {
  const Vec6d residual = geom::BetweenResidual(graph.world_T_node[static_cast<std::size_t>(edge.a)],
                                               graph.world_T_node[static_cast<std::size_t>(edge.b)], edge.a_T_b);
  return (residual.array() / edge.sigma.array()).square().sum();
}

SolveReport Solve(PoseGraph* graph, int max_iterations) {
  CheckGraph(*graph);
  SolveReport report;
  report.chi2_before = TotalChi2(*graph);
  report.chi2_after = report.chi2_before;
  if (graph->world_T_node.size() < 2) {
    report.converged = true;
    return report;
  }
  NormalEquations equations(*graph);
  double damping = kFirstDamping;
  while (report.iterations < max_iterations && !report.converged) {
    equations.Linearize();
    bool improved = false;
    while (!improved && damping < kGreatestDamping) {
      Eigen::VectorXd step;
      if (!equations.Step(damping, &step)) {
        damping = std::max(10 * damping, kFirstDamping);
        continue;
      }
      const std::vector<Pose3> before = graph->world_T_node;
      for (int i = 0; i < static_cast<int>(before.size()); ++i) {
        const int column = equations.Column(i);
        Pose3& node = graph->world_T_node[static_cast<std::size_t>(i)];
        if (column >= 0) node = geom::Retract(node, step.segment<6>(column));
      }
      const double chi2 = TotalChi2(*graph);
      const double decrease = report.chi2_after - chi2;
      if (std::isfinite(chi2) && decrease >= 0) {
        improved = true;
        report.converged = step.cwiseAbs().maxCoeff() < kSmallStep || decrease <= kSmallDecrease * (chi2 + 1e-12);
        report.chi2_after = chi2;
        damping = std::max(0.1 * damping, 1e-12);
      } else {
        graph->world_T_node = before;
        report.converged = step.cwiseAbs().maxCoeff() < kSmallStep;
        if (report.converged) break;
        damping *= 10;
      }
    }
    ++report.iterations;
    if (!improved) break;
  }
  return report;
}

}  // namespace mapweld::merge
