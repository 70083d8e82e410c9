// SPDX-License-Identifier: Apache-2.0
// What an MTi-630 adds to the truth: white noise, and biases that differ from switch-on to switch-on and creep.
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
};

struct ImuError {
  geom::Vec3d gyro;   // rad/s
  geom::Vec3d accel;  // m/s^2
};

// The error of sample `index`, t seconds after the start.
ImuError DrawImuError(const ImuModel& model, std::uint64_t seed, std::uint64_t index, double t);

}  // namespace mapweld::sim
