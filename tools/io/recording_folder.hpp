// SPDX-License-Identifier: Apache-2.0
// A folder with the scans and the poses of any LiDAR odometry, read the same way whatever wrote it:
//   KITTI    velodyne/*.bin, poses.txt (12 numbers per scan), optional times.txt, optional calib.txt. With a line "Tr:"
//            in calib.txt the poses are those of the camera, as on KITTI: world_T_lidar = Tr^-1 * pose * Tr.
//   others   *.pcd or *.ply (in DIR, DIR/clouds, ...) and a TUM trajectory (poses.txt, trajectory.txt, *.tum, ...).
//            File names that are times meet the pose nearest in time; others take one row per cloud in order.
// Clouds and trajectories combine freely. Clouds are in the sensor frame, metres.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "core/geom/pose3.hpp"

namespace mapweld::io {

struct LoadedScan {
  std::vector<Eigen::Vector3f> points;  // p_lidar
  std::size_t dropped = 0;              // not finite, or exactly at the origin: marks of a missing return
};

class RecordingFolder {
 public:
  // Reads the poses and checks what can be checked without reading the clouds. Throws one sentence that names the file
  // and the remedy.
  static RecordingFolder Open(const std::filesystem::path& recording);

  [[nodiscard]] const std::string& name() const { return name_; }  // of the folder
  [[nodiscard]] std::size_t size() const { return clouds_.size(); }
  [[nodiscard]] const std::vector<std::filesystem::path>& clouds() const { return clouds_; }
  [[nodiscard]] const std::vector<TimeNs>& times() const { return times_; }  // strictly increasing
  [[nodiscard]] const std::vector<geom::Pose3>& world_T_lidar() const { return world_T_lidar_; }
  // What the user should know although it is no error, one sentence each.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  // Reads one cloud. May be called from several threads.
  [[nodiscard]] LoadedScan LoadScan(std::size_t i) const;

 private:
  std::string name_;
  std::vector<std::filesystem::path> clouds_;
  std::vector<TimeNs> times_;
  std::vector<geom::Pose3> world_T_lidar_;
  std::vector<std::string> notes_;
};

}  // namespace mapweld::io
