// SPDX-License-Identifier: Apache-2.0
// The cloud of one group: the submaps of its drives where the merge puts them, thinned to one point per voxel.
#pragma once

#include <vector>

#include "core/geom/pose3.hpp"
#include "tools/io/point_cloud.hpp"
#include "tools/merge/drive.hpp"
#include "tools/merge/merge_result.hpp"

namespace mapweld::report {

struct MapPoint {
  Eigen::Vector3f p_merged;  // m, mean of all submap points in the voxel
  int drive = 0;             // the first drive that saw the voxel
};

// The frame of a keyframe's submap in the merged frame. Submaps are level (core/submap/submap.hpp): roll and pitch of
// the odometry are already taken out of them.
geom::Pose3 MergedTLevel(const geom::Pose3& merged_T_body, const geom::Pose3& odom_T_body);

// Sorted by voxel, the same bytes for the same input. Of each drive the submaps about 10 m apart and the last one are
// used; keyframes whose submap is missing are passed over. One hash look-up per submap point; 32 bytes per voxel of a
// table that is between 3/8 and 3/4 full. Points beyond 262 km at 0.25 m are dropped.
std::vector<MapPoint> BuildGroupMap(const std::vector<merge::Drive>& drives, const merge::MergeResult& result,
                                    int group, merge::SubmapSource* submaps, double voxel_m = 0.4);

// Coloured by drive.
io::PointCloud ColoredByDrive(const std::vector<MapPoint>& points);

}  // namespace mapweld::report
