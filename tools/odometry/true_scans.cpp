// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/true_scans.hpp"

#include <array>

#include "tools/eval/trajectory_error.hpp"

namespace mapweld::odometry {

TrueScans::TrueScans(std::vector<io::StampedPose> world_T_body, const geom::Pose3& body_T_lidar,
                     std::function<void(const TrueScan&)> take)
    : world_T_body_(std::move(world_T_body)), body_T_lidar_(body_T_lidar), take_(std::move(take)) {}

void TrueScans::OnPacket(const sensor::LidarPacket& packet) {
  bool has_scan = false;
  (void)accumulator_->Add(packet, scan_.get(), &has_scan);
  if (has_scan) Undistort(*scan_);
}

void TrueScans::Flush() {
  if (accumulator_->Flush(scan_.get())) Undistort(*scan_);
}

void TrueScans::Undistort(const sensor::Scan& scan) {
  constexpr std::size_t kSteps = scan::ScanMotion::kSteps;
  std::array<geom::Pose3, kSteps + 1> world_T_lidar;
  for (std::size_t i = 0; i <= kSteps; ++i) {
    const DurationNs since{(scan.t_end - scan.t_begin).ns * static_cast<std::int64_t>(i) /
                           static_cast<std::int64_t>(kSteps)};
    geom::Pose3 world_T_body;
    if (!eval::TruthAt(world_T_body_, scan.t_begin + since, &world_T_body)) return;
    world_T_lidar[i] = world_T_body * body_T_lidar_;
  }
  const geom::Pose3 end_T_world = world_T_lidar[kSteps].Inverse();
  scan::ScanMotion motion;
  for (std::size_t i = 0; i <= kSteps; ++i) motion.end_T_body[i] = end_T_world * world_T_lidar[i];
  scan::Deskew(scan, motion, geom::Pose3{}, scan::DeskewConfig{}, points_.get());

  TrueScan out{scan.t_end, world_T_lidar[kSteps], {}};
  for (const scan::BodyPoint& point : *points_) out.points.push_back(point.p);
  take_(out);
}

}  // namespace mapweld::odometry
