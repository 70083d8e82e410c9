// SPDX-License-Identifier: Apache-2.0
// The roadside in pieces of 7.5 m, left and right of every street: where things along it have their places.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/sim/sight.hpp"
#include "tools/sim/town.hpp"

namespace mapweld::sim {

struct Plot {
  Vec2d on_street;       // its middle, projected to the centre line
  Vec2d along;           // direction of the street
  Vec2d outward;         // away from it
  double half_width_m;   // of the carriageway
  std::uint64_t seed;    // of this plot: from the street's id and the place along it
  std::uint64_t street;  // from the street's id
  int number = 0;        // along the street, from 1

  // Metres along the street from the middle, and beyond the kerb.
  [[nodiscard]] Vec2d At(double along_m, double outward_m) const {
    return on_street + along_m * along + (half_width_m + outward_m) * outward;
  }
};

inline constexpr double kPlot_m = 7.5;

// Of all furnished streets, those whose middle is in sight; left side before right side.
std::vector<Plot> PlotsAlongStreets(const Town& town, const Sight& sight);

}  // namespace mapweld::sim
