// SPDX-License-Identifier: Apache-2.0
// The files of the KITTI odometry benchmark: velodyne clouds, poses, times and the calibration's Tr.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/base/time.hpp"
#include "core/geom/pose3.hpp"
#include "tools/io/point_cloud.hpp"

namespace mapweld::io {

inline constexpr std::size_t kKittiPointBytes = 16;  // float32 x y z intensity

// Throws unless the size is a whole number of points.
PointCloud ReadKittiCloud(const std::filesystem::path& path);
void WriteKittiCloud(const std::filesystem::path& path, const PointCloud& cloud);

// One row is the upper 3x4 part of a pose, row-major. Throws with file and line for rows of another length, for
// anything that is not a number, and for rotations that are none.
std::vector<geom::Pose3> ReadKittiPoses(const std::filesystem::path& path);
void WriteKittiPoses(const std::filesystem::path& path, const std::vector<geom::Pose3>& world_T_body);

// One time in seconds per row.
std::vector<TimeNs> ReadKittiTimes(const std::filesystem::path& path);

// camera_T_lidar from the line "Tr:" of a calib.txt; nothing when the file has no such line.
std::optional<geom::Pose3> ReadKittiCalibration(const std::filesystem::path& path);

}  // namespace mapweld::io
