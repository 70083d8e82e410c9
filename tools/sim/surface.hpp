// SPDX-License-Identifier: Apache-2.0
// What a laser beam meets and how much light comes back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mapweld::sim {

enum class Surface : std::uint8_t { kRoad, kGrass, kWall, kRoof, kFoliage, kTrunk, kPole, kCar, kGardenWall };
inline constexpr std::size_t kSurfaces = 9;

// Share of the light that a surface scatters back, and how much that differs from one piece of it to the next.
struct Reflectance {
  double mean;
  double spread;
};
inline constexpr std::array<Reflectance, kSurfaces> kReflectance{{{0.14, 0.02},
                                                                  {0.30, 0.06},
                                                                  {0.45, 0.22},
                                                                  {0.25, 0.08},
                                                                  {0.35, 0.12},
                                                                  {0.25, 0.08},
                                                                  {0.55, 0.15},
                                                                  {0.40, 0.30},
                                                                  {0.40, 0.15}}};

}  // namespace mapweld::sim
