// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace mapweld::sensor {

// One return, in the lidar frame (x forward, y left, z up).
struct LidarPoint {
  float x = 0;  // m
  float y = 0;
  float z = 0;
  float intensity = 0;     // 0..255
  std::int32_t dt_ns = 0;  // firing time after the stamp of the packet or scan that holds the point
  std::uint16_t ring = 0;  // beam, 0 = lowest
  std::uint16_t reserved = 0;
};

}  // namespace mapweld::sensor
