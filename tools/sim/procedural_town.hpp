// SPDX-License-Identifier: Apache-2.0
// Towns that nobody built: a bent grid of streets with houses along them, any number from a seed, so that training
// never runs out of streets.
#pragma once

#include <cstdint>
#include <string>

#include "tools/sim/town.hpp"
#include "tools/sim/town_style.hpp"

namespace mapweld::sim {

struct TownPlan {
  std::string style;  // see town_style.hpp
  double size_m = 0;  // side of the square that it fills
  std::uint64_t seed = 0;
  double cellar_m = 0;  // how deep under ground one half of its streets lie; 0: none do
};

// Houses and gardens of a style to the left of a line along a street; `corner_m` stays free at its beginning. Ids count
// up from `*next_id`.
void AddRowOfHouses(const Polyline& line, double half_width_m, double corner_m, const TownStyle& style,
                    std::uint64_t seed, std::int64_t* next_id, Town* town);

// Centred on the origin. Depends on the plan only.
Town InventTown(const TownPlan& plan);

}  // namespace mapweld::sim
