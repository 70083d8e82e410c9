// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/receiver.hpp"

#include <algorithm>
#include <cmath>

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {

Receiver::Receiver(const LidarModel& model, const Weather& weather)
    : range_sigma_m_(model.range_sigma_m), range_step_m_(model.range_step_m), half_signal_(model.half_signal) {
  constexpr double kDecibelPerNeper = 4.343;
  extinction_per_m_ = weather.fog_visibility_m > 0 ? 3.912 / weather.fog_visibility_m : 0;
  if (weather.rain_mm_per_h > 0) {
    extinction_per_m_ += 1.076 * std::pow(weather.rain_mm_per_h, 0.67) / 1000 / kDecibelPerNeper;
  }
  wet_ = weather.rain_mm_per_h > 0 ? 0.7 : 1.0;
  drop_share_ = std::min(0.05, 4 * extinction_per_m_);
}

LidarReturn Receiver::Measure(double distance_m, double reflectance, std::uint64_t random_bits) const {
  const double measured_m = distance_m + range_sigma_m_ * Gaussian(random_bits);
  const double steps = std::max(std::round(measured_m / range_step_m_), 1.0);
  const double reflectivity =
      std::clamp(std::round(100 * reflectance + 3 * Gaussian(Mix(random_bits + 2))), 1.0, 100.0);
  return {static_cast<float>(steps * range_step_m_), static_cast<std::uint8_t>(reflectivity)};
}

LidarReturn Receiver::Detect(Surface surface, std::uint32_t patch, double distance_m, double cos_incidence,
                             std::uint64_t random_bits) const {
  constexpr double kLostAnyway = 0.003;
  const Material& material = kMaterials[static_cast<std::size_t>(surface)];
  const std::uint64_t of_patch = Hash(patch, static_cast<std::uint64_t>(surface), 0xFACE);
  const double rho = std::clamp(material.reflectance + material.spread * Uniform(of_patch, -1, 1), 0.01, 1.0) * wet_;
  const double signal =
      rho * cos_incidence * std::exp(-2 * extinction_per_m_ * distance_m) / std::max(distance_m * distance_m, 0.01);
  const double seen = signal * signal / (signal * signal + half_signal_ * half_signal_) - kLostAnyway;
  if (Uniform(Mix(random_bits + 1)) >= seen) return DetectAir(distance_m, random_bits);
  return Measure(distance_m + material.depth_m * Uniform(Mix(random_bits + 3)), rho, random_bits);
}

LidarReturn Receiver::DetectAir(double free_m, std::uint64_t random_bits) const {
  if (Uniform(Mix(random_bits + 4)) >= drop_share_) return {};
  // Light falls off with the square of the distance: most drops that are seen are close.
  const double u = Uniform(Mix(random_bits + 5));
  const double distance_m = 1.5 / (1 - 0.9 * u);
  if (distance_m >= free_m) return {};
  return Measure(distance_m, 0.02, random_bits);
}

}  // namespace mapweld::sim
