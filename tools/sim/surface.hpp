// SPDX-License-Identifier: Apache-2.0
// What a laser beam meets and how much light comes back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mapweld::sim {

enum class Surface : std::uint8_t {
  kRoad,
  kGrass,
  kWall,
  kRoof,
  kFoliage,
  kTrunk,
  kPole,
  kCar,
  kGardenWall,
  kHedge,
  kGlass,
  kPerson,
  kSign,
  kFootway
};
inline constexpr std::size_t kSurfaces = 14;

struct Material {
  // Share of the light that a surface scatters back, and how much that differs from one piece of it to the next.
  double reflectance;
  double spread;
  // How deep a beam may get into it before it comes back: grass, twigs.
  double depth_m;
};
inline constexpr std::array<Material, kSurfaces> kMaterials{{{0.14, 0.02, 0},
                                                             {0.30, 0.06, 0.04},
                                                             {0.45, 0.22, 0},
                                                             {0.25, 0.08, 0.03},
                                                             {0.35, 0.12, 0.12},
                                                             {0.25, 0.08, 0},
                                                             {0.55, 0.15, 0},
                                                             {0.40, 0.30, 0},
                                                             {0.40, 0.15, 0},
                                                             {0.35, 0.12, 0.18},
                                                             {0.03, 0.015, 0},
                                                             {0.35, 0.25, 0.02},
                                                             {1.00, 0, 0},
                                                             {0.22, 0.03, 0}}};

}  // namespace mapweld::sim
