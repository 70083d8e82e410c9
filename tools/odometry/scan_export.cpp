// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/scan_export.hpp"

#include <fmt/format.h>

#include "tools/io/atomic_file.hpp"
#include "tools/io/kitti.hpp"

namespace mapweld::odometry {

ScanExport::ScanExport(const std::filesystem::path& folder) : folder_(folder) {
  std::filesystem::create_directories(folder_ / "velodyne");
}

void ScanExport::Write(const TrueScan& scan) {
  io::PointCloud cloud;
  cloud.points = scan.points;
  io::WriteKittiCloud(folder_ / "velodyne" / fmt::format("{:06}.bin", times_.size()), cloud);
  times_.push_back(scan.t);
  world_T_lidar_.push_back(scan.world_T_lidar);
}

std::size_t ScanExport::Finish() {
  io::WriteKittiPoses(folder_ / "poses.txt", world_T_lidar_);
  io::AtomicFile times(folder_ / "times.txt");
  for (const TimeNs t : times_) times.Write(fmt::format("{:.9f}\n", static_cast<double>(t.ns) * 1e-9));
  times.Commit();
  return times_.size();
}

}  // namespace mapweld::odometry
