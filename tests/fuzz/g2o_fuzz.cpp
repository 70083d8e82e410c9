// SPDX-License-Identifier: Apache-2.0
// The input is a pose graph as a g2o file.
#include <exception>
#include <set>
#include <string_view>

#include "tests/fuzz/fuzz.hpp"
#include "tools/io/g2o.hpp"

namespace mapweld::fuzz {

std::vector<Bytes> Seeds() {
  return TextSeeds(
      {"VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1.5 2e-3 -3 0.5 0.5 0.5 0.5\nFIX 0\n"
       "EDGE_SE3:QUAT 0 1 1 2 3 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 4 0 0 4 0 4\n",
       "# remark\r\nPARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\r\nVERTEX_SE3:QUAT -7 nan 0 0 0 0 0 1\r\n\r\nFIX 1 2\r\n",
       "EDGE_SE3:QUAT 3 3 inf 0 0 0 0 0 0 1e308 0 0 0 0 0 1 0 0 0 0 1 0 0 0 -4 0 0 4 0 1e999"});
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  const fuzz::Bytes bytes(data, data + size);
  try {
    const io::PoseGraphFile graph = io::ParseG2o({reinterpret_cast<const char*>(bytes.data()), size}, "input");
    std::set<std::int64_t> ids;
    for (const io::PoseGraphVertex& vertex : graph.vertices) {
      FUZZ_REQUIRE(vertex.world_T_vertex.IsValid());
      FUZZ_REQUIRE(ids.insert(vertex.id).second);
    }
    for (const io::PoseGraphEdge& edge : graph.edges) FUZZ_REQUIRE(edge.line > 0);
  } catch (const std::exception& error) {
    FUZZ_REQUIRE(std::string_view(error.what()).starts_with("input:"));
  }
  return 0;
}
