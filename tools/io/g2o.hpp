// SPDX-License-Identifier: Apache-2.0
// Pose graphs for g2o, GTSAM and their viewers: VERTEX_SE3:QUAT, FIX, EDGE_SE3:QUAT.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/geom/pose3.hpp"

namespace mapweld::io {

struct PoseGraphVertex {
  std::int64_t id = 0;
  geom::Pose3 world_T_vertex;
  bool fixed = false;
};

struct PoseGraphEdge {
  std::int64_t a = 0;
  std::int64_t b = 0;
  geom::Pose3 a_T_b;
  geom::Mat6d information;  // of the error in our tangent order, m^-2 and rad^-2
};

struct PoseGraphFile {
  std::vector<PoseGraphVertex> vertices;
  std::vector<PoseGraphEdge> edges;
};

// g2o measures a rotation by the vector part of its quaternion, half the angle: the rotational information is written
// four times, the mixed part twice as large as ours.
void WriteG2o(const std::filesystem::path& path, const PoseGraphFile& graph);

}  // namespace mapweld::io
