// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_graph/graph_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>

#include "tests/unit/tools/pose_graph/block_graph.hpp"
#include "tools/pose_graph/graph_file.hpp"
#include "tools/pose_graph/solve.hpp"

namespace mapweld::pose_graph {
namespace {

using test::Block;
using test::NoisyBlock;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Fault {
  const char* text;
  std::function<void(Edge*)> make;
};

const std::vector<Fault>& Faults() {
  static const std::vector<Fault> faults = {
      {"is not finite", [](Edge* e) { e->a_T_b.t.x() = kNan; }},
      {"is not finite", [](Edge* e) { e->a_T_b.q.w() = kInf; }},
      {"quaternion that is not of unit length", [](Edge* e) { e->a_T_b.q.coeffs().setZero(); }},
      {"information that is not finite", [](Edge* e) { e->information(2, 3) = kNan; }},
      {"above 1e20", [](Edge* e) { e->information *= 1e30; }},
      {"negative eigenvalue", [](Edge* e) { e->information(4, 4) = -1; }},
      {"negative eigenvalue", [](Edge* e) { e->information(0, 1) = e->information(1, 0) = 1e6; }},
      {"not symmetric", [](Edge* e) { e->information(0, 1) = 5; }},
      {"information of zero", [](Edge* e) { e->information.setZero(); }},
      {"ties a node to itself", [](Edge* e) { e->b = e->a; }},
      {"ends at a node that does not exist", [](Edge* e) { e->b = 400; }},
      {"ends at a node that does not exist", [](Edge* e) { e->a = -1; }},
      {"weight outside 0..1", [](Edge* e) { e->weight = 2; }},
      {"weight outside 0..1", [](Edge* e) { e->weight = kNan; }},
  };
  return faults;
}

TEST(GraphChecks, RefuseABadEdgeByNameAndSolveTheRestAsIfItWereNotThere) {
  PoseGraph clean = NoisyBlock(Block());
  (void)Solve(&clean, {});
  for (const Fault& fault : Faults()) {
    SCOPED_TRACE(fault.text);
    PoseGraph graph = NoisyBlock(Block());
    Edge bad = graph.edges[7];
    fault.make(&bad);
    graph.edges.insert(graph.edges.begin() + 20, bad);
    const std::vector<RefusedEdge> refused = RemoveFaultyEdges(&graph);
    ASSERT_EQ(refused.size(), 1U);
    EXPECT_EQ(refused[0].index, 20U);
    EXPECT_THAT(refused[0].fault, HasSubstr(fault.text));
    (void)Solve(&graph, {});
    EXPECT_LT(test::WorstError(graph.world_T_node, clean.world_T_node), 1e-9);
  }
}

void ExpectRefused(const PoseGraph& graph, const std::string& fault) {
  PoseGraph copy = graph;
  try {
    (void)Solve(&copy, {});
    ADD_FAILURE() << "accepted: " << fault;
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(fault));
  }
}

TEST(GraphChecks, NameEveryFaultBeforeSolving) {
  const PoseGraph good = NoisyBlock(Block());
  PoseGraph empty;
  empty.held.clear();
  ExpectRefused(empty, "no nodes");
  PoseGraph bad = good;
  bad.edges.erase(bad.edges.begin() + 40);
  bad.edges.pop_back();
  ExpectRefused(bad, "node 41 is not connected to a held node");
  bad = good;
  bad.held.clear();
  ExpectRefused(bad, "node 0 is not connected to a held node");
  bad = good;
  bad.held = {80};
  ExpectRefused(bad, "the held node 80 does not exist");
  bad = good;
  bad.world_T_node[2].t.z() = kInf;
  ExpectRefused(bad, "the start of node 2 is not a pose");
  bad = good;
  bad.edges[3].weight = 0;
  bad.edges[60].weight = 0;
  ExpectRefused(bad, "node 4 is not connected");
  bad = good;
  bad.edges[5].a_T_b.q.coeffs().setZero();
  ExpectRefused(bad, "edge 5 (5 to 6) has a quaternion that is not of unit length");
}

TEST(GraphChecks, ASingleNodeIsSolved) {
  PoseGraph graph;
  graph.world_T_node.resize(1);
  EXPECT_TRUE(Solve(&graph, {}).converged);
}

TEST(GraphChecks, PartsThatHangTogetherWithNothingKeepFramesOfTheirOwn) {
  PoseGraph graph = NoisyBlock(Block());
  const PoseGraph other = NoisyBlock(Block());
  for (const geom::Pose3& pose : other.world_T_node) graph.world_T_node.push_back(pose);
  for (Edge edge : other.edges) {
    edge.a += 80;
    edge.b += 80;
    graph.edges.push_back(edge);
  }
  HoldEveryComponent(&graph);
  EXPECT_EQ(graph.held, (std::vector<int>{0, 80}));
  const ComponentsReport report = SolveComponents(&graph, {});
  EXPECT_EQ(report.components, 2);
  EXPECT_EQ(report.not_converged, 0);
  for (int i = 0; i < 80; ++i) {
    EXPECT_EQ(graph.world_T_node[static_cast<std::size_t>(i)].t,
              graph.world_T_node[static_cast<std::size_t>(i + 80)].t);
  }
}

}  // namespace
}  // namespace mapweld::pose_graph
