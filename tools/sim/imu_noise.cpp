// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/imu_noise.hpp"

#include <cmath>
#include <numbers>

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {
namespace {

double AxisError(std::uint64_t seed, std::uint64_t axis, std::uint64_t index, double t, double white_sigma,
                 double bias_sigma, double creep) {
  const double period_s = Uniform(Hash(seed, axis, 1), 150, 400);
  const double phase = Uniform(Hash(seed, axis, 2), 0, 2 * std::numbers::pi);
  return white_sigma * Gaussian(Hash(seed, axis, 16 + index)) + bias_sigma * Gaussian(Hash(seed, axis, 3)) +
         creep * std::sin(2 * std::numbers::pi * t / period_s + phase);
}

struct Trembling {
  double gyro = 0;
  double accel = 0;
};

Trembling AxisTrembling(std::uint64_t seed, std::uint64_t axis, double t, double rms) {
  constexpr std::uint64_t kTones = 4;
  constexpr double kLever_m = 0.5;
  const double amplitude = rms * std::sqrt(2.0 / kTones);
  Trembling sum;
  for (std::uint64_t tone = 0; tone < kTones; ++tone) {
    const double omega = 2 * std::numbers::pi * Uniform(Hash(seed, axis, 4 + tone), 12, 80);
    const double phase = Uniform(Hash(seed, axis, 8 + tone), 0, 2 * std::numbers::pi);
    sum.accel += amplitude * std::sin(omega * t + phase);
    sum.gyro -= amplitude / (kLever_m * omega) * std::cos(omega * t + phase);
  }
  return sum;
}

}  // namespace

ImuError DrawImuError(const ImuModel& model, std::uint64_t seed, std::uint64_t index, double t) {
  const double bandwidth = std::sqrt(model.rate_hz);
  ImuError error;
  for (int axis = 0; axis < 3; ++axis) {
    const auto stream = static_cast<std::uint64_t>(axis);
    error.gyro[axis] = AxisError(seed, stream, index, t, model.gyro_noise_density * bandwidth, model.gyro_bias_sigma,
                                 model.gyro_creep);
    error.accel[axis] = AxisError(seed, 8 + stream, index, t, model.accel_noise_density * bandwidth,
                                  model.accel_bias_sigma, model.accel_creep);
    if (model.vibration_mps2 <= 0) continue;
    const Trembling trembling = AxisTrembling(seed, 16 + stream, t, model.vibration_mps2);
    error.gyro[axis] += trembling.gyro;
    error.accel[axis] += trembling.accel;
  }
  return error;
}

}  // namespace mapweld::sim
