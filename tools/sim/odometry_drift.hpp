// SPDX-License-Identifier: Apache-2.0
// What a good LiDAR-inertial odometry would make of a drive: the truth, bent a little more with every metre.
#pragma once

#include <cstdint>

#include "core/geom/pose3.hpp"

namespace mapweld::sim {

// Standard deviations. With these, 0.4 to 0.5 % of the path after one kilometre and half a degree off level at worst.
struct OdometryModel {
  double yaw_walk_rad = 2.5e-4;  // per square root of a metre
  double height_walk_m = 4e-3;   // per square root of a metre
  double scale = 2e-3;           // one per drive
  double tilt_rad = 2e-3;        // one per drive: what the start took for level
};

// Step by step from the true poses. The frame it starts in is level but otherwise any.
class DriftingOdometry {
 public:
  DriftingOdometry(const OdometryModel& model, std::uint64_t seed);
  // The pose in the odom frame that belongs to the next true pose.
  geom::Pose3 Next(const geom::Pose3& world_T_body);

 private:
  OdometryModel model_;
  std::uint64_t seed_;
  std::uint64_t steps_ = 0;
  double scale_;
  geom::Quatd tilt_;
  geom::Pose3 true_before_;
  geom::Pose3 walked_;  // before the tilt
};

}  // namespace mapweld::sim
