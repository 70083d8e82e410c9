// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/base/fixed_vector.hpp"
#include "core/base/time.hpp"
#include "core/config/capacity.hpp"
#include "core/sensor/lidar_point.hpp"

namespace mapweld::sensor {

// The decoded content of one LiDAR datagram.
struct LidarPacket {
  TimeNs t;                              // first firing
  std::uint16_t azimuth_first_cdeg = 0;  // of the first firing, 0..35999 hundredths of a degree, sensor's own zero
  std::uint16_t azimuth_last_cdeg = 0;   // of the last block
  FixedVector<LidarPoint, kCap.packet_points> points;  // returns only, in firing order
};

}  // namespace mapweld::sensor
