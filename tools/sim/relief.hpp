// SPDX-License-Identifier: Apache-2.0
// Hills: how high the ground is everywhere.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "tools/sim/polygon.hpp"
#include "tools/sim/town_mesh.hpp"

namespace mapweld::sim {

class Relief {
 public:
  // A few long waves in random directions, 300 to 900 m from crest to crest; `amplitude_m` is their standard deviation.
  // The ground never rises more steeply than amplitude_m * 0.067.
  Relief(double amplitude_m, std::uint64_t seed);

  [[nodiscard]] double Height(const Vec2d& p) const;
  [[nodiscard]] Vec2d Slope(const Vec2d& p) const;  // metres up per metre east and north
  // Puts what was built on flat ground onto the hills.
  void Lift(TownMesh* mesh) const;

 private:
  struct Wave {
    Vec2d direction_per_m;
    double amplitude_m;
    double phase;
  };
  std::array<Wave, 5> waves_;
};

}  // namespace mapweld::sim
