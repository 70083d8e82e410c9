// SPDX-License-Identifier: Apache-2.0
// Pose graphs as g2o, GTSAM and Ceres exchange them: VERTEX_SE3:QUAT, FIX, EDGE_SE3:QUAT.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "core/geom/pose3.hpp"

namespace mapweld::io {

struct PoseGraphVertex {
  std::int64_t id = 0;
  geom::Pose3 world_T_vertex;
  bool fixed = false;
};

// The information is of the rotation vector, m^-2 and rad^-2, as GTSAM and Ceres read and publish these files. (The
// program g2o itself measures half the angle and so gives rotations a quarter of that weight.)
struct PoseGraphEdge {
  std::int64_t a = 0;
  std::int64_t b = 0;
  geom::Pose3 a_T_b;
  geom::Mat6d information;
  int line = 0;  // where it was read
};

struct PoseGraphFile {
  std::vector<PoseGraphVertex> vertices;
  std::vector<PoseGraphEdge> edges;
};

void WriteG2o(const std::filesystem::path& path, const PoseGraphFile& graph);

// Throws one sentence with file and line for what is not a pose graph: another record, a number that is none, too few
// or too many of them, a vertex twice, a vertex whose pose is not finite or whose quaternion is zero. Edges are taken
// as they are written, also where they make no sense ("nan", a vertex that is not listed); quaternions that are about
// of unit length are made so. PARAMS_SE3OFFSET is passed over.
PoseGraphFile ReadG2o(const std::filesystem::path& path);
// The same for the text of a file; `name` is what errors call it.
PoseGraphFile ParseG2o(std::string_view text, std::string_view name);

}  // namespace mapweld::io
