// SPDX-License-Identifier: Apache-2.0
// What an MTi-630 adds to the truth: white noise, biases that differ from switch-on to switch-on and creep, and the
// trembling of what it is screwed to.
#pragma once

#include <cstdint>

#include "core/geom/so3.hpp"

namespace mapweld::sim {

struct ImuModel {
  double rate_hz = 200;
  double gyro_noise_density = 0.007 * 3.14159265358979 / 180;  // rad/s/sqrt(Hz)
  double accel_noise_density = 60e-6 * 9.81;                   // m/s^2/sqrt(Hz)
  double gyro_bias_sigma = 1.5e-3;                             // rad/s, at switch-on
  double accel_bias_sigma = 0.015;                             // m/s^2
  double gyro_creep = 2e-4;                                    // rad/s, amplitude of the slow change
  double accel_creep = 3e-3;                                   // m/s^2
  // Root mean square of the acceleration along each axis: four tones between 12 and 80 Hz. About an axis as if that
  // were the trembling of a point half a metre aside. It moves the LiDAR by less than 0.1 mm per m/s^2, so its scans
  // stay as they are.
  double vibration_mps2 = 0;
};

struct ImuError {
  geom::Vec3d gyro;   // rad/s
  geom::Vec3d accel;  // m/s^2
};

// The error of sample `index`, t seconds after the start.
ImuError DrawImuError(const ImuModel& model, std::uint64_t seed, std::uint64_t index, double t);

}  // namespace mapweld::sim
