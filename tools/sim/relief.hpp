// SPDX-License-Identifier: Apache-2.0
// How high the ground is everywhere, and the streets, which lie on it but for those of a cellar.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "tools/sim/cellar.hpp"
#include "tools/sim/polygon.hpp"
#include "tools/sim/town_mesh.hpp"

namespace mapweld::sim {

class Relief {
 public:
  // A few long waves in random directions, 300 to 900 m from crest to crest; `amplitude_m` is their standard deviation.
  // The ground never rises more steeply than amplitude_m * 0.067.
  Relief(double amplitude_m, std::uint64_t seed, const std::optional<Cellar>& cellar = {});

  // Of the ground.
  [[nodiscard]] double Height(const Vec2d& p) const;
  [[nodiscard]] Vec2d Slope(const Vec2d& p) const;  // metres up per metre east and north
  // Of the street at a place where there is one.
  [[nodiscard]] double StreetHeight(const Vec2d& p) const;
  [[nodiscard]] Vec2d StreetSlope(const Vec2d& p) const;
  // Puts what was built on flat ground onto the hills.
  void Lift(TownMesh* mesh) const;
  // The same for what moves in the streets.
  void LiftOntoStreet(TownMesh* mesh) const;

 private:
  struct Wave {
    Vec2d direction_per_m;
    double amplitude_m;
    double phase;
  };
  std::array<Wave, 5> waves_;
  std::optional<Cellar> cellar_;
};

}  // namespace mapweld::sim
