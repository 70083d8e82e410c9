// SPDX-License-Identifier: Apache-2.0
// Trajectories as the TUM RGB-D benchmark writes them and evo reads them: "time x y z qx qy qz qw" per row.
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/time.hpp"
#include "core/geom/pose3.hpp"

namespace mapweld::io {

struct StampedPose {
  TimeNs t;
  geom::Pose3 world_T_body;
};

// In order of time. Throws with file and line for malformed rows, times that do not increase, and quaternions far from
// unit length (shorter than 0.9 or longer than 1.1); nearly unit ones are normalised.
std::vector<StampedPose> ReadTum(const std::filesystem::path& path);
void WriteTum(const std::filesystem::path& path, const std::vector<StampedPose>& trajectory);

}  // namespace mapweld::io
