// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/pose_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

#include "tools/merge/robust_solve.hpp"

namespace mapweld::merge {
namespace {

using geom::Pose3;
using geom::Vec3d;
using geom::Vec6d;
using ::testing::HasSubstr;

class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  Pose3 Of(const Pose3& pose, const Vec6d& sigma) {
    Vec6d delta;
    for (int i = 0; i < 6; ++i) delta[i] = sigma[i] * normal_(random_);
    return geom::Retract(pose, delta);
  }
  double Uniform(double low, double high) { return low + (high - low) * static_cast<double>(random_() % 100000) / 1e5; }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

Vec6d Sigma(double metres, double radians) {
  Vec6d out;
  out << metres, metres, metres, radians, radians, radians;
  return out;
}

// Round a block: 80 poses on a square of 100 m.
std::vector<Pose3> Block() {
  std::vector<Pose3> out;
  for (int k = 0; k < 80; ++k) {
    const int side = k / 20;
    const double yaw_rad = side * 1.5707963;
    static const Vec3d corners[] = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}};
    const Vec3d along = geom::ExpSo3({0, 0, yaw_rad}) * Vec3d(5.0 * (k % 20), 0, 0);
    out.push_back({corners[side] + along, geom::ExpSo3({0, 0, yaw_rad})});
  }
  return out;
}

GraphEdge Edge(const std::vector<Pose3>& truth, int a, int b, const Vec6d& sigma, Noise* noise) {
  const Pose3 exact = truth[static_cast<std::size_t>(a)].Inverse() * truth[static_cast<std::size_t>(b)];
  return {a, b, noise == nullptr ? exact : noise->Of(exact, sigma), sigma, 1};
}

PoseGraph NoisyBlock(const std::vector<Pose3>& truth) {
  Noise noise(4);
  PoseGraph graph;
  graph.world_T_node.push_back(truth[0]);
  for (int k = 0; k + 1 < static_cast<int>(truth.size()); ++k) {
    graph.edges.push_back(Edge(truth, k, k + 1, Sigma(0.05, 0.01), &noise));
    graph.world_T_node.push_back(graph.world_T_node.back() * graph.edges.back().a_T_b);
  }
  graph.edges.push_back(Edge(truth, static_cast<int>(truth.size()) - 1, 0, Sigma(0.05, 0.002), &noise));
  return graph;
}

double WorstError(const std::vector<Pose3>& estimate, const std::vector<Pose3>& truth) {
  double worst = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) worst = std::max(worst, (estimate[i].t - truth[i].t).norm());
  return worst;
}

TEST(PoseGraph, ClosesANoisyLoop) {
  const std::vector<Pose3> truth = Block();
  PoseGraph graph = NoisyBlock(truth);
  const double before = WorstError(graph.world_T_node, truth);
  const SolveReport report = Solve(&graph, 50);
  EXPECT_TRUE(report.converged);
  EXPECT_LT(report.chi2_after, 0.2 * report.chi2_before);
  EXPECT_LT(WorstError(graph.world_T_node, truth), 0.6 * before);
  EXPECT_EQ(graph.world_T_node[0].t, truth[0].t) << "the anchor moved";
  EXPECT_LT(report.chi2_after, 60) << "six numbers of freedom are left: chi2 must be small";
}

TEST(PoseGraph, GivesTheSameBitsTwice) {
  PoseGraph x = NoisyBlock(Block());
  PoseGraph y = NoisyBlock(Block());
  (void)Solve(&x, 50);
  (void)Solve(&y, 50);
  for (std::size_t i = 0; i < x.world_T_node.size(); ++i) EXPECT_EQ(x.world_T_node[i].t, y.world_T_node[i].t);
}

TEST(PoseGraph, WorksWithTheAnchorInTheMiddle) {
  const std::vector<Pose3> truth = Block();
  PoseGraph graph = NoisyBlock(truth);
  graph.anchor = 33;
  const Pose3 held = graph.world_T_node[33];
  EXPECT_TRUE(Solve(&graph, 50).converged);
  EXPECT_EQ(graph.world_T_node[33].t, held.t);
}

void ExpectRefused(const PoseGraph& graph, const std::string& fault) {
  PoseGraph copy = graph;
  try {
    (void)Solve(&copy, 10);
    ADD_FAILURE() << "accepted: " << fault;
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(fault));
  }
}

TEST(PoseGraphChecks, NameEveryFaultBeforeSolving) {
  const PoseGraph good = NoisyBlock(Block());
  ExpectRefused({}, "no nodes");
  PoseGraph bad = good;
  bad.edges.erase(bad.edges.begin() + 40);
  bad.edges.pop_back();
  ExpectRefused(bad, "node 41 is not connected to the anchor");
  bad = good;
  bad.edges[3].a_T_b.t.x() = std::numeric_limits<double>::quiet_NaN();
  ExpectRefused(bad, "edge 3 (3 to 4) is not finite");
  bad = good;
  bad.edges[5].a_T_b.q.coeffs().setZero();
  ExpectRefused(bad, "edge 5 (5 to 6) has a quaternion that is not of unit length");
  bad = good;
  bad.edges[7].sigma[2] = 0;
  ExpectRefused(bad, "edge 7 (7 to 8) has a sigma that is not positive");
  bad = good;
  bad.edges[7].sigma[2] = 1e-9;
  ExpectRefused(bad, "too far apart");
  bad = good;
  bad.edges[7].b = 400;
  ExpectRefused(bad, "does not exist");
  bad = good;
  bad.edges[7].b = 7;
  ExpectRefused(bad, "ties a node to itself");
  bad = good;
  bad.edges[7].weight = 2;
  ExpectRefused(bad, "weight outside 0..1");
  bad = good;
  bad.anchor = 80;
  ExpectRefused(bad, "the anchor, node 80, does not exist");
  bad = good;
  bad.world_T_node[2].t.z() = std::numeric_limits<double>::infinity();
  ExpectRefused(bad, "start of node 2");
}

// Three drives round the same block in frames of their own, tied by true loops and by wrong ones.
ChainGraph ThreeDrives(double wrong_share, unsigned seed, std::vector<Pose3>* truth) {
  Noise noise(seed);
  const std::vector<Pose3> block = Block();
  ChainGraph graph;
  const int n = static_cast<int>(block.size());
  for (int chain = 0; chain < 3; ++chain) {
    Pose3 frame;
    if (chain > 0)
      frame = {{noise.Uniform(-300, 300), noise.Uniform(-300, 300), 3}, geom::ExpSo3({0, 0, noise.Uniform(-3, 3)})};
    const int first = chain * n;
    for (int k = 0; k < n; ++k) {
      truth->push_back(block[static_cast<std::size_t>(k)]);
      graph.chain_of.push_back(chain);
      if (k == 0) {
        graph.chain_T_node.push_back(frame * block[0]);
        continue;
      }
      GraphEdge edge = Edge(block, k - 1, k, Sigma(0.05, 0.003), &noise);
      graph.chain_T_node.push_back(graph.chain_T_node.back() * edge.a_T_b);
      edge.a += first;
      edge.b += first;
      graph.odometry.push_back(edge);
    }
  }
  const int true_loops = 60;
  const int wrong_loops = static_cast<int>(wrong_share * true_loops / (1 - wrong_share));
  for (int i = 0; i < true_loops + wrong_loops; ++i) {
    const int chain_a = i % 3 == 2 ? 1 : 0;
    const int chain_b = i % 3 == 0 ? 1 : 2;
    const int k = static_cast<int>(noise.Uniform(0, n));
    const int l = static_cast<int>(noise.Uniform(0, n));
    GraphEdge edge = Edge(block, k, i < true_loops ? k : l, Sigma(0.2, 0.01), &noise);
    if (i >= true_loops)
      edge.a_T_b = {{noise.Uniform(-5, 5), noise.Uniform(-5, 5), 0}, geom::ExpSo3({0, 0, noise.Uniform(-3, 3)})};
    edge.a = chain_a * n + k;
    edge.b = chain_b * n + (i < true_loops ? k : l);
    graph.loops.push_back(edge);
  }
  return graph;
}

class RobustSolve : public ::testing::TestWithParam<int> {};

TEST_P(RobustSolve, KeepsTheMapWhereItIsWhateverWrongLoopsAreAdded) {
  std::vector<Pose3> truth;
  const ChainGraph clean = ThreeDrives(0, 17, &truth);
  const double error_clean = WorstError(SolveRobust(clean, {}).world_T_node, truth);
  truth.clear();
  const ChainGraph dirty = ThreeDrives(GetParam() / 100.0, 17, &truth);
  const RobustResult result = SolveRobust(dirty, {});
  EXPECT_LT(error_clean, 1.5);
  EXPECT_LT(WorstError(result.world_T_node, truth), error_clean + 0.3);
  for (std::size_t i = 0; i < dirty.loops.size(); ++i) {
    if (i < 60) {
      EXPECT_GT(result.loop_weight[i], 0.5) << "true loop " << i;
    } else {
      EXPECT_LT(result.loop_weight[i], 0.1) << "wrong loop " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(WrongPercent, RobustSolve, ::testing::Values(10, 30, 50));

TEST(RobustSolveChecks, RefuseDrivesThatNoLoopTies) {
  std::vector<Pose3> truth;
  ChainGraph graph = ThreeDrives(0, 17, &truth);
  std::erase_if(graph.loops, [](const GraphEdge& edge) { return edge.b >= 160; });
  EXPECT_THROW((void)SolveRobust(graph, {}), std::runtime_error);
}

}  // namespace
}  // namespace mapweld::merge
