// SPDX-License-Identifier: Apache-2.0
// Writes scans as a KITTI folder, so that any other odometry can run on the very same data.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/odometry/true_scans.hpp"

namespace mapweld::odometry {

// `folder`/velodyne/NNNNNN.bin (x y z and an intensity of 0), times.txt (ends of the scans) and poses.txt
// (world_T_lidar of the truth).
class ScanExport {
 public:
  // Throws std::runtime_error when the folder cannot be made, as Write and Finish do when it cannot be written.
  explicit ScanExport(const std::filesystem::path& folder);
  void Write(const TrueScan& scan);
  // Writes the tables; gives the number of scans.
  std::size_t Finish();

 private:
  std::filesystem::path folder_;
  std::vector<TimeNs> times_;
  std::vector<geom::Pose3> world_T_lidar_;
};

}  // namespace mapweld::odometry
