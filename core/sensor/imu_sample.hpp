// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/base/time.hpp"

namespace mapweld::sensor {

// One inertial measurement in the body frame (x forward, y left, z up). At rest and level, accel is (0, 0, +9.81).
struct ImuSample {
  TimeNs t;
  Eigen::Vector3d gyro_body = Eigen::Vector3d::Zero();   // rad/s
  Eigen::Vector3d accel_body = Eigen::Vector3d::Zero();  // m/s^2, specific force
  bool clipped = false;                                  // an axis ran into its range
};

}  // namespace mapweld::sensor
