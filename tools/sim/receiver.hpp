// SPDX-License-Identifier: Apache-2.0
// What becomes of the light of one shot: range noise, and returns that get lost in the distance, at grazing incidence,
// in dark surfaces, rain and fog.
#pragma once

#include <cstdint>

#include "tools/sim/lidar_model.hpp"
#include "tools/sim/surface.hpp"

namespace mapweld::sim {

struct Weather {
  double rain_mm_per_h = 0;
  double fog_visibility_m = 0;  // 0: no fog
};

struct LidarReturn {
  float distance_m = 0;           // 0: none; a multiple of the model's step
  std::uint8_t reflectivity = 0;  // 0..100 diffuse
};

class Receiver {
 public:
  Receiver(const LidarModel& model, const Weather& weather);

  // The same random bits give the same return. Detection probability s^2 / (s^2 + h^2) of the signal
  // s = rho cos(i) exp(-2 a r) / r^2. The extinction a is 3.912 / visibility in fog (Koschmieder), and
  // 1.076 R^0.67 dB/km in R mm/h of rain (Carbonneau and Wisely, 1998).
  [[nodiscard]] LidarReturn Detect(Surface surface, std::uint32_t patch, double distance_m, double cos_incidence,
                                   std::uint64_t random_bits) const;
  // A shot that met nothing, or nothing that came back: now and then a raindrop or fog close by answers.
  [[nodiscard]] LidarReturn DetectAir(double free_m, std::uint64_t random_bits) const;

 private:
  [[nodiscard]] LidarReturn Measure(double distance_m, double reflectance, std::uint64_t random_bits) const;
  double range_sigma_m_;
  double range_step_m_;
  double half_signal_;
  double extinction_per_m_;
  double wet_;         // what is left of a wet surface's reflectance
  double drop_share_;  // of the shots that a drop answers
};

}  // namespace mapweld::sim
