// SPDX-License-Identifier: Apache-2.0
#include "tools/io/g2o.hpp"

#include <fmt/format.h>

#include <string>

#include "tools/io/atomic_file.hpp"

namespace mapweld::io {
namespace {

std::string PoseText(const geom::Pose3& pose) {
  return fmt::format("{:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}", pose.t.x(), pose.t.y(), pose.t.z(),
                     pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w());
}

}  // namespace

void WriteG2o(const std::filesystem::path& path, const PoseGraphFile& graph) {
  AtomicFile file(path);
  for (const PoseGraphVertex& v : graph.vertices) {
    file.Write(fmt::format("VERTEX_SE3:QUAT {} {}\n", v.id, PoseText(v.world_T_vertex)));
  }
  for (const PoseGraphVertex& v : graph.vertices) {
    if (v.fixed) file.Write(fmt::format("FIX {}\n", v.id));
  }
  for (const PoseGraphEdge& e : graph.edges) {
    std::string line = fmt::format("EDGE_SE3:QUAT {} {} {}", e.a, e.b, PoseText(e.a_T_b));
    for (Eigen::Index r = 0; r < 6; ++r) {
      for (Eigen::Index c = r; c < 6; ++c) {
        const double scale = (r < 3 ? 1.0 : 2.0) * (c < 3 ? 1.0 : 2.0);
        line += fmt::format(" {:.9g}", scale * e.information(r, c));
      }
    }
    file.Write(line += '\n');
  }
  file.Commit();
}

}  // namespace mapweld::io
