// SPDX-License-Identifier: Apache-2.0
// Undoes the vehicle's motion during one revolution: all points as if seen at the end of the scan.
#pragma once

#include <array>
#include <cstddef>

#include "core/base/fixed_vector.hpp"
#include "core/geom/pose3.hpp"
#include "core/sensor/scan.hpp"

namespace mapweld::scan {

// A point in the body frame at the end of the scan.
struct BodyPoint {
  Eigen::Vector3f p;  // m
};
using BodyPoints = FixedVector<BodyPoint, kCap.scan_points>;

// The body's motion during a scan as end_T_body(t) on an even grid over [t_begin, t_end]; linear in between. With 64
// steps over 0.1 s at 10 m/s and 1 rad/s the interpolation error is below 0.1 mm at 50 m.
struct ScanMotion {
  static constexpr std::size_t kSteps = 64;
  std::array<geom::Pose3, kSteps + 1> end_T_body;
};

struct DeskewConfig {
  float min_range_m = 1.5F;  // the vehicle's own body
  float max_range_m = 100.0F;
};

// Fills *out with the points in range. Cost: about 12 multiply-adds per point.
void Deskew(const sensor::Scan& scan, const ScanMotion& motion, const geom::Pose3& body_T_lidar,
            const DeskewConfig& config, BodyPoints* out);

}  // namespace mapweld::scan
