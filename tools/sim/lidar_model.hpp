// SPDX-License-Identifier: Apache-2.0
// What distinguishes one spinning LiDAR from another: which way its beams look, when they fire, how far they see.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geom/pose3.hpp"

namespace mapweld::sim {

struct Beam {
  double elevation_deg = 0;
  double azimuth_deg = 0;     // beside the direction in which the sensor looks, clockwise seen from above
  std::int64_t fires_ns = 0;  // after the first beam of its column
};

struct LidarModel {
  std::string name;
  std::vector<Beam> beams;     // in the order of the sensor's numbering; a multiple of 16
  std::int64_t column_ps = 0;  // from one firing of all beams to the next
  float max_range_m = 0;
  double range_sigma_m = 0;
  double range_step_m = 0;    // of the numbers that the sensor sends
  double half_signal = 0;     // reflectance * cos(incidence) / range^2 at which half of the shots come back
  double divergence_rad = 0;  // standard deviation across a beam of where the return comes from
  // Standard deviations of what calibration leaves of each beam's errors; they stay the same for a whole drive.
  double beam_range_sigma_m = 0;
  double beam_elevation_sigma_rad = 0;
  geom::Pose3 body_T_lidar{{0.10, 0, 0.35}, geom::Quatd::Identity()};

  // When column `index` begins, after column 0.
  [[nodiscard]] std::int64_t ColumnStart_ns(std::int64_t index) const { return index * column_ps / 1000; }
};

// "vlp16", "hdl32e", "hdl64e", "os1-64", "128": angles and timing of the manuals; the last is no product but what the
// 128-beam ones have in common. All turn ten times a second. Throws std::runtime_error listing them for any other.
LidarModel LidarByName(const std::string& name);

}  // namespace mapweld::sim
