// SPDX-License-Identifier: Apache-2.0
#include "tools/io/g2o.hpp"

#include <gtest/gtest.h>

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
  EXPECT_EQ(file.Number(edge, 15), 6);    // translation with rotation: twice
  EXPECT_EQ(file.Number(edge, 30), 100);  // rotation: four times, as g2o works with half angles
}

}  // namespace
}  // namespace mapweld::io
