// SPDX-License-Identifier: Apache-2.0
// Keyframes with their submaps, whoever made them: from a folder with scans and poses as the merge does, or from an LCM
// log of what agents sent.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "tools/merge/drive.hpp"
#include "tools/merge/progress.hpp"

namespace mapweld::describe {

inline constexpr double kSubmapRadius_m = 50;  // as the agent cuts them

struct KeyframeSource {
  merge::Drive drive;
  std::vector<int> scans;              // per keyframe: the scan it was taken at; of a log, its own index
  std::vector<geom::Vec3d> positions;  // per keyframe, in the frame of the recording's poses or the agent's odometry
  // Null for a submap that a log does not hold. Not for two threads at once.
  std::function<std::shared_ptr<const merge::SubmapCloud>(int keyframe)> submap;
};

// One source per drive in it. `radius_m` is how far submaps made from scans reach; those in a log are as they were
// sent. Throws std::runtime_error naming the input. Holds all submaps of a folder, about 200 kB each.
std::vector<KeyframeSource> OpenKeyframes(const std::filesystem::path& path, double radius_m, int threads,
                                          merge::Progress* progress);

}  // namespace mapweld::describe
