// SPDX-License-Identifier: Apache-2.0
// Writes what a merge found as files that other programs read:
//   groups.json                   {"groups": [{"recordings": [names]}]}, largest group first
//   overlaps.json                 every pair of drives that was looked at, accepted or not, and the test that decided
//   group_1/map.ply, map.pcd      the merged cloud, coloured by drive
//   group_1/pose_graph.g2o        odometry and loops of the group
//   trajectory_NAME.tum           one drive in its group's frame, as evo reads it, and trajectory_NAME.kitti.txt, 3x4
//   rows
// The same input gives the same bytes. Each file is put in place whole; files that an earlier merge left in `folder`
// and this one does not write again are removed once all others are there.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/io/tum.hpp"
#include "tools/merge/drive.hpp"
#include "tools/merge/merge_result.hpp"
#include "tools/report/merged_map.hpp"

namespace mapweld::report {

// `maps`: the cloud of each group, as BuildGroupMap gives it. `trajectories`: per drive the merged poses to write, for
// example one per scan; where that is empty, the keyframes are written. Throws one sentence when a file cannot be
// written.
void WriteMergeOutput(const std::filesystem::path& folder, const std::vector<merge::Drive>& drives,
                      const merge::MergeResult& result, const std::vector<std::vector<MapPoint>>& maps,
                      const std::vector<std::vector<io::StampedPose>>& trajectories = {});

std::string GroupsJson(const std::vector<merge::Drive>& drives, const merge::MergeResult& result);
// Transforms are 4x4 row-major, metres. "transform" of a pair (a, b) maps the odometry frame of b into that of a;
// "a_T_b" of a loop maps the level frame of keyframe b into that of keyframe a.
std::string OverlapsJson(const std::vector<merge::Drive>& drives, const merge::MergeResult& result);
// Vertices are keyframes, numbered through all drives of the merge; the first one of the group is fixed.
void WritePoseGraph(const std::filesystem::path& path, const std::vector<merge::Drive>& drives,
                    const merge::MergeResult& result, int group);

}  // namespace mapweld::report
