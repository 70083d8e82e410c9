// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/solve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "tests/support/shared_data.hpp"
#include "tests/unit/tools/pose_graph/block_graph.hpp"
#include "tools/io/g2o.hpp"
#include "tools/pose_graph/graph_file.hpp"
#include "tools/pose_graph/marginals.hpp"
#include "tools/pose_graph/normal_equations.hpp"

namespace mapweld::pose_graph {
namespace {

using geom::Mat6d;
using geom::Pose3;
using geom::Vec6d;
using test::Block;
using test::NoisyBlock;
using test::WorstError;

// The block with rungs across, so that nodes with three and more neighbours are left when the chains are gone.
PoseGraph Ladder() {
  const std::vector<Pose3> truth = Block();
  PoseGraph graph = NoisyBlock(truth);
  test::Noise noise(9);
  for (int k = 3; k < 40; k += 4) graph.edges.push_back(test::EdgeOf(truth, k, 79 - k, test::Sigma(0.1, 0.01), &noise));
  Mat6d slanted = graph.edges.back().information;
  slanted(0, 4) = slanted(4, 0) = 20;
  slanted(1, 5) = slanted(5, 1) = -30;
  graph.edges.back().information = slanted;
  return graph;
}

// H of the whole graph by LinearizeBetween, dense, without the held node 0.
Eigen::MatrixXd DenseHessian(const PoseGraph& graph) {
  const auto n = static_cast<Eigen::Index>(6 * graph.world_T_node.size());
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
  for (const Edge& edge : graph.edges) {
    const geom::BetweenLinearization l =
        geom::LinearizeBetween(graph.world_T_node[static_cast<std::size_t>(edge.a)],
                               graph.world_T_node[static_cast<std::size_t>(edge.b)], edge.a_T_b);
    const Mat6d information = edge.weight * edge.information;
    h.block<6, 6>(6 * edge.a, 6 * edge.a) += l.jacobian_a.transpose() * information * l.jacobian_a;
    h.block<6, 6>(6 * edge.b, 6 * edge.b) += l.jacobian_b.transpose() * information * l.jacobian_b;
    h.block<6, 6>(6 * edge.a, 6 * edge.b) += l.jacobian_a.transpose() * information * l.jacobian_b;
    h.block<6, 6>(6 * edge.b, 6 * edge.a) += l.jacobian_b.transpose() * information * l.jacobian_a;
  }
  return h.bottomRightCorner(n - 6, n - 6);
}

TEST(Solve, ClosesANoisyLoop) {
  const std::vector<Pose3> truth = Block();
  PoseGraph graph = NoisyBlock(truth);
  const double before = WorstError(graph.world_T_node, truth);
  const SolveReport report = Solve(&graph, {});
  EXPECT_TRUE(report.converged);
  EXPECT_LT(report.cost_after, 0.2 * report.cost_before);
  EXPECT_LT(report.cost_after, 30) << "six numbers of freedom are left: the cost must be small";
  EXPECT_LT(WorstError(graph.world_T_node, truth), 0.6 * before);
  EXPECT_EQ(graph.world_T_node[0].t, truth[0].t) << "the held node moved";
}

TEST(Solve, TakesTheStepThatDenseAlgebraTakes) {
  const PoseGraph graph = Ladder();
  const GraphPattern pattern = PatternOf(graph);
  NormalEquations equations(&graph, &pattern);
  EXPECT_NEAR(equations.Linearize(graph.world_T_node), Cost(graph), 1e-9 * Cost(graph));
  ASSERT_TRUE(equations.Solve(0));
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(6 * graph.world_T_node.size()));
  for (const Edge& edge : graph.edges) {
    const geom::BetweenLinearization l =
        geom::LinearizeBetween(graph.world_T_node[static_cast<std::size_t>(edge.a)],
                               graph.world_T_node[static_cast<std::size_t>(edge.b)], edge.a_T_b);
    gradient.segment<6>(6 * edge.a) += l.jacobian_a.transpose() * edge.information * l.residual;
    gradient.segment<6>(6 * edge.b) += l.jacobian_b.transpose() * edge.information * l.residual;
  }
  const Eigen::VectorXd step = -DenseHessian(graph).llt().solve(gradient.tail(gradient.size() - 6));
  for (int node = 1; node < static_cast<int>(graph.world_T_node.size()); ++node) {
    EXPECT_LT((equations.Step(node) - step.segment<6>(6 * (node - 1))).norm(), 1e-7 * step.norm()) << "node " << node;
  }
}

TEST(Solve, KnowsCovariancesAsTheDenseInverseDoes) {
  PoseGraph graph = Ladder();
  (void)Solve(&graph, {});
  const Marginals marginals(&graph);
  const Eigen::MatrixXd inverse = DenseHessian(graph).inverse();
  EXPECT_EQ(marginals.OfNode(0), Mat6d(Mat6d::Zero()));
  for (int node = 1; node < 80; ++node) {
    const Mat6d expected = inverse.block<6, 6>(6 * (node - 1), 6 * (node - 1));
    EXPECT_LT((marginals.OfNode(node) - expected).norm(), 1e-7 * expected.norm()) << "node " << node;
  }
  // A loop knows its relative pose better than the chain between its ends does.
  EXPECT_LT(marginals.OfEdge(3, 76).trace(), marginals.OfNode(40).trace());
  const geom::BetweenLinearization l = geom::LinearizeBetween(graph.world_T_node[3], graph.world_T_node[76],
                                                              graph.world_T_node[3].Inverse() * graph.world_T_node[76]);
  Eigen::Matrix<double, 6, 12> jacobian;
  jacobian << l.jacobian_a, l.jacobian_b;
  Eigen::Matrix<double, 12, 12> joint;
  joint << inverse.block<6, 6>(12, 12), inverse.block<6, 6>(12, 450), inverse.block<6, 6>(450, 12),
      inverse.block<6, 6>(450, 450);
  const Mat6d expected = jacobian * joint * jacobian.transpose();
  EXPECT_LT((marginals.OfEdge(3, 76) - expected).norm(), 1e-7 * expected.norm());
}

TEST(Solve, GivesTheSameBitsInAnyOrderOfEdges) {
  PoseGraph first = Ladder();
  (void)Solve(&first, {});
  std::mt19937 random(3);
  for (int trial = 0; trial < 10; ++trial) {
    PoseGraph other = Ladder();
    for (std::size_t i = other.edges.size() - 1; i > 0; --i) std::swap(other.edges[i], other.edges[random() % (i + 1)]);
    (void)Solve(&other, {});
    for (std::size_t i = 0; i < first.world_T_node.size(); ++i) {
      ASSERT_EQ(first.world_T_node[i].t, other.world_T_node[i].t);
      ASSERT_EQ(first.world_T_node[i].q.coeffs(), other.world_T_node[i].q.coeffs());
    }
  }
}

TEST(Solve, WorksWithTheHeldNodeInTheMiddleAndWithTwoOfThem) {
  PoseGraph graph = NoisyBlock(Block());
  graph.held = {33, 50};
  const Pose3 held = graph.world_T_node[33];
  EXPECT_TRUE(Solve(&graph, {}).converged);
  EXPECT_EQ(graph.world_T_node[33].t, held.t);
}

TEST(Solve, FindsItsWayFromNoStartAtAll) {
  const std::vector<Pose3> truth = Block();
  PoseGraph good = Ladder();
  PoseGraph lost = good;
  for (Pose3& pose : lost.world_T_node) pose = good.world_T_node[0];
  SolveConfig config;
  config.start = Start::kBetter;
  const SolveReport report = Solve(&lost, config);
  EXPECT_TRUE(report.chordal);
  EXPECT_NEAR(report.cost_after, Solve(&good, {}).cost_after, 1e-4);
}

// 1e-12 to 1e12 (reliability: ill-conditioned weights).
TEST(Solve, EndsWithFinitePosesWhateverTheScales) {
  test::Noise noise(5);
  for (int trial = 0; trial < 30; ++trial) {
    PoseGraph graph = Ladder();
    for (Edge& edge : graph.edges) edge.information *= std::pow(10.0, noise.Uniform(-12, 12));
    const double before = Cost(graph);
    SolveConfig config;
    config.max_iterations = 30;
    const SolveReport report = Solve(&graph, config);
    EXPECT_LE(report.iterations, 30);
    EXPECT_LE(report.cost_after, (1 + 1e-9) * before);
    for (const Pose3& pose : graph.world_T_node) ASSERT_TRUE(pose.IsValid());
  }
}

struct Standard {
  const char* name;
  double cost;
};

class StandardGraphs : public ::testing::TestWithParam<Standard> {};

// Best known costs. They are of an error whose position part differs a little from ours, hence the tolerance.
TEST_P(StandardGraphs, ReachTheBestKnownCost) {
  const auto path = test::SharedData(std::string("pose_graphs/") + GetParam().name + ".g2o");
  if (!path.has_value()) GTEST_SKIP() << GetParam().name << " is not here (../shared/data/pose_graphs)";
  PoseGraph graph = FromFile(io::ReadG2o(*path)).graph;
  SolveConfig config;
  config.start = Start::kBetter;
  const SolveReport report = Solve(&graph, config);
  EXPECT_TRUE(report.converged);
  EXPECT_NEAR(report.cost_after, GetParam().cost, 5e-4 * GetParam().cost);
}

INSTANTIATE_TEST_SUITE_P(All, StandardGraphs,
                         ::testing::Values(Standard{"sphere2500", 675.74}, Standard{"torus3D", 12119.5},
                                           Standard{"parking-garage", 0.6342}),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace mapweld::pose_graph
