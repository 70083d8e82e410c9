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

// Published truth often has positions alone, with something in the last four columns that is no rotation (NCLT's Euler
// angles, zeros). Who needs only positions reads those too; rotations that are none become the identity.
enum class PoseUse { kWhole, kPositions };

// In order of time. Throws with file and line for malformed rows, times that do not increase, and (kWhole) quaternions
// far from unit length (shorter than 0.9 or longer than 1.1); nearly unit ones are normalised.
std::vector<StampedPose> ReadTum(const std::filesystem::path& path, PoseUse use = PoseUse::kWhole);
void WriteTum(const std::filesystem::path& path, const std::vector<StampedPose>& trajectory);

}  // namespace mapweld::io
