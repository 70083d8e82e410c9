// SPDX-License-Identifier: Apache-2.0
#include "tools/io/g2o.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/unit/tools/io/temp_folder.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

TEST(G2o, WritesVerticesFixAndTheUpperTriangleOfTheInformation) {
  const test::TempFolder folder;
  PoseGraphFile graph;
  graph.vertices = {{0, {}, true}, {7, {{1, 2, 3}, geom::Quatd(0, 0, 0, 1)}, false}};
  geom::Mat6d information = geom::Mat6d::Zero();
  information(0, 0) = 100;
  information(0, 5) = information(5, 0) = 3;
  information(5, 5) = 25;
  graph.edges = {{0, 7, {{1, 2, 3}, geom::Quatd::Identity()}, information}};
  WriteG2o(folder / "a.g2o", graph);
  const TextRows file(folder / "a.g2o");
  ASSERT_EQ(file.rows().size(), 4U);
  EXPECT_EQ(file.rows()[1].words[0], "VERTEX_SE3:QUAT");
  EXPECT_EQ(file.Number(file.rows()[1], 1), 7);
  EXPECT_EQ(file.Number(file.rows()[1], 7), 1) << "quaternions are x y z w";
  EXPECT_EQ(file.rows()[2].words, (std::vector<std::string_view>{"FIX", "0"}));
  const TextRow& edge = file.rows()[3];
  ASSERT_EQ(edge.words.size(), 3U + 7U + 21U);
  EXPECT_EQ(file.Number(edge, 10), 100);
  EXPECT_EQ(file.Number(edge, 15), 3);
  EXPECT_EQ(file.Number(edge, 30), 25) << "information is of the rotation vector";
}

TEST(G2o, ReadsWhatItWrites) {
  const test::TempFolder folder;
  PoseGraphFile graph;
  graph.vertices = {{5, {{1, 2, 3}, geom::Quatd(0.5, 0.5, -0.5, 0.5)}, false}, {-2, {}, true}};
  geom::Mat6d information = geom::Mat6d::Identity();
  information(1, 4) = information(4, 1) = 0.25;
  graph.edges = {{5, -2, {{0.5, 0, -1}, geom::Quatd(0, 1, 0, 0)}, information}};
  WriteG2o(folder / "a.g2o", graph);
  const PoseGraphFile read = ReadG2o(folder / "a.g2o");
  ASSERT_EQ(read.vertices.size(), 2U);
  EXPECT_EQ(read.vertices[0].id, 5);
  EXPECT_EQ(read.vertices[0].world_T_vertex.t, graph.vertices[0].world_T_vertex.t);
  EXPECT_EQ(read.vertices[0].world_T_vertex.q.coeffs(), graph.vertices[0].world_T_vertex.q.coeffs());
  EXPECT_TRUE(read.vertices[1].fixed);
  ASSERT_EQ(read.edges.size(), 1U);
  EXPECT_EQ(read.edges[0].b, -2);
  EXPECT_EQ(read.edges[0].a_T_b.t, graph.edges[0].a_T_b.t);
  EXPECT_EQ(read.edges[0].information, information);
  EXPECT_EQ(read.edges[0].line, 4);
}

std::string ErrorOf(const std::string& text) {
  try {
    (void)ParseG2o(text, "a.g2o");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(G2o, SaysWhatIsWrongAndInWhichLine) {
  const std::string vertex = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n";
  EXPECT_EQ(ErrorOf(vertex + "# remark\n\nVERTEX_SE3:QUAT 1 0 0 zero 0 0 0 1\n"), "a.g2o:4: 'zero' is not a number");
  EXPECT_EQ(ErrorOf(vertex + "VERTEX_SE3:QUAT 1 0 0 0 0 0 0\n"),
            "a.g2o:2: found 7 values where 8 belong (id x y z qx qy qz qw)");
  EXPECT_EQ(ErrorOf(vertex + vertex), "a.g2o:2: vertex 0 is there twice; remove one");
  EXPECT_EQ(ErrorOf("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0\n"),
            "a.g2o:1: vertex 0 is not a pose: finite numbers and a quaternion of unit length");
  EXPECT_EQ(ErrorOf("VERTEX_SE2 0 1 2 3\n"),
            "a.g2o:1: 'VERTEX_SE2' is not known here; VERTEX_SE3:QUAT, EDGE_SE3:QUAT and FIX are");
  EXPECT_EQ(ErrorOf(vertex + "FIX 7\n"), "a.g2o:2: FIX names vertex 7, which is not in the file");
  EXPECT_EQ(ErrorOf("FIX a\n"), "a.g2o:1: 'a' is not the number of a vertex");
}

TEST(G2o, TakesAnEdgeThatMakesNoSenseAsItIsWritten) {
  std::string line = "EDGE_SE3:QUAT 3 3 nan 0 0 0 0 0 0";
  for (int i = 0; i < 21; ++i) line += " -1e30";
  const PoseGraphFile graph = ParseG2o(line, "a.g2o");
  ASSERT_EQ(graph.edges.size(), 1U);
  EXPECT_TRUE(std::isnan(graph.edges[0].a_T_b.t.x()));
  EXPECT_EQ(graph.edges[0].information(5, 5), -1e30);
}

}  // namespace
}  // namespace mapweld::io
