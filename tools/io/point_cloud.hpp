// SPDX-License-Identifier: Apache-2.0
// Points as files hold them: metres, with colour or intensity for all points or for none.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace mapweld::io {

using Rgb = std::array<std::uint8_t, 3>;

struct PointCloud {
  std::vector<Eigen::Vector3f> points;
  std::vector<Rgb> colors;         // empty or as many as points
  std::vector<float> intensities;  // empty or as many as points; the sensor's own unit
};

enum class Encoding { kAscii, kBinary };

}  // namespace mapweld::io
