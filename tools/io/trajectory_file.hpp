// SPDX-License-Identifier: Apache-2.0
// Finds and reads the trajectory of a recording, whatever its name and format.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "core/geom/pose3.hpp"
#include "tools/io/tum.hpp"

namespace mapweld::io {

struct Trajectory {
  std::filesystem::path path;
  std::vector<geom::Pose3> world_T_lidar;
  std::vector<TimeNs> times;  // as many as poses; empty for KITTI rows, which carry none
};

// The file: poses.txt, trajectory.txt and other usual names in `recording`, or its only *.tum, *_tum.txt or
// *_kitti.txt, or ../../poses/NAME.txt as the KITTI benchmark is laid out. Throws when there is none or the choice is
// not clear.
std::filesystem::path FindTrajectory(const std::filesystem::path& recording);

// Rows of 12 numbers are KITTI's, rows of 8 are TUM's. Throws with file and line for anything else.
Trajectory ReadTrajectory(const std::filesystem::path& path, PoseUse use = PoseUse::kWhole);

}  // namespace mapweld::io
