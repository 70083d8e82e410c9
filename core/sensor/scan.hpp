// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/fixed_vector.hpp"
#include "core/base/time.hpp"
#include "core/config/capacity.hpp"
#include "core/sensor/lidar_point.hpp"

namespace mapweld::sensor {

// One revolution of the LiDAR, as measured (not de-skewed), lidar frame. dt_ns counts from t_begin.
struct Scan {
  TimeNs t_begin;
  TimeNs t_end;
  FixedVector<LidarPoint, kCap.scan_points> points;
};

}  // namespace mapweld::sensor
