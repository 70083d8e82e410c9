// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/lidar_model.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

namespace mapweld::sim {
namespace {

// VLP-16 manual 63-9243: every 2.304 us the next laser, -15, 1, -13, 3, ... degrees.
LidarModel Vlp16() {
  LidarModel model{"vlp16", {}, 55'296'000, 100, 0.02, 0.002, 5e-6, 0.6e-3};
  for (int i = 0; i < 16; ++i) {
    const double elevation_deg = i % 2 == 0 ? -15 + i : i;
    model.beams.push_back({elevation_deg, 0, i * 2304});
  }
  return model;
}

// HDL-32E manual 63-9113: every 1.152 us the next laser, two interleaved fans of 16, 4/3 degrees from beam to beam.
LidarModel Hdl32e() {
  LidarModel model{"hdl32e", {}, 46'080'000, 100, 0.02, 0.002, 5e-6, 0.8e-3};
  for (int i = 0; i < 32; ++i) {
    const double lowest = i % 2 == 0 ? -92.0 / 3 : -28.0 / 3;
    model.beams.push_back({lowest + i / 2 * 4.0 / 3, 0, i * 1152});
  }
  return model;
}

// HDL-64E: an upper block from +2 degrees in thirds, a lower one from -8.83 in halves. Noise and errors of the beams as
// in real scans of a road (docs/realism.md): it jitters far less than the light is wide, as the receiver averages over
// it.
LidarModel Hdl64e() {
  LidarModel model{"hdl64e", {}, 48'000'000, 120, 0.009, 0.002, 4e-6, 0.07e-3};
  model.beam_range_sigma_m = 0.03;
  model.beam_elevation_sigma_rad = 1.2e-3;
  for (int i = 0; i < 64; ++i) {
    const double elevation_deg = i < 32 ? 2 - i / 3.0 : -8.83 - (i - 32) / 2.0;
    model.beams.push_back({elevation_deg, 0, i / 4 * 2880});
  }
  return model;
}

// OS1-64: all beams of a column at once, 1024 columns per turn, four staggered columns of emitters.
LidarModel Os1() {
  constexpr std::array<double, 4> kStagger_deg{-3.164, -1.055, 1.055, 3.164};
  LidarModel model{"os1-64", {}, 97'656'250, 110, 0.02, 0.001, 7e-6, 1.0e-3};
  for (int i = 0; i < 64; ++i) {
    model.beams.push_back({16.611 - i * 33.222 / 63, kStagger_deg[static_cast<std::size_t>(i % 4)], 0});
  }
  return model;
}

// 128 beams, dense about the horizon, eight at a time.
LidarModel Beams128() {
  LidarModel model{"128", {}, 53'300'000, 200, 0.02, 0.004, 1.5e-6, 0.5e-3};
  double elevation_deg = 15;
  for (int i = 0; i < 128; ++i) {
    model.beams.push_back({elevation_deg, 0, i / 8 * 2665});
    elevation_deg -= i < 16 ? 0.7 : i < 104 ? 0.125 : 0.75;
  }
  return model;
}

}  // namespace

LidarModel LidarByName(const std::string& name) {
  std::string known;
  for (const LidarModel& model : {Vlp16(), Hdl32e(), Hdl64e(), Os1(), Beams128()}) {
    if (model.name == name) return model;
    known += known.empty() ? model.name : ", " + model.name;
  }
  throw std::runtime_error(fmt::format("there is no LiDAR '{}'; known are {}", name, known));
}

}  // namespace mapweld::sim
