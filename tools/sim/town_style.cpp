// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/town_style.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <vector>

namespace mapweld::sim {
namespace {

constexpr std::array<TownStyle, 5> kStyles{{
    {.name = "old_town",
     .block_x_m = 75,
     .block_y_m = 62,
     .jitter = 0.16,
     .bend_m = 5,
     .swirl_m = 45,
     .removed = 0.13,
     .half_width_m = 2.8,
     .main_street_every = 5,
     .main_half_width_m = 4.5,
     .covered_share = 0,
     .highways = false,
     .front_m = {5, 15},
     .depth_m = {8, 14},
     .height_m = {7, 17},
     .setback_m = {1.6, 2.6},
     .gap_m = {2, 6},
     .gap_share = 0.12,
     .wing = 0.35,
     .flat_roofs = false,
     .hedge = 0,
     .fence = 0.02,
     .tree = 0.04},
    {.name = "suburb",
     .block_x_m = 130,
     .block_y_m = 78,
     .jitter = 0.10,
     .bend_m = 9,
     .swirl_m = 60,
     .removed = 0.15,
     .half_width_m = 3.0,
     .main_street_every = 5,
     .main_half_width_m = 3.6,
     .covered_share = 0,
     .highways = false,
     .front_m = {8, 15},
     .depth_m = {8, 12},
     .height_m = {4.5, 9},
     .setback_m = {3.5, 9},
     .gap_m = {4, 16},
     .gap_share = 0.85,
     .wing = 0.3,
     .flat_roofs = false,
     .hedge = 0.35,
     .fence = 0.35,
     .tree = 0.35},
    {.name = "industry",
     .block_x_m = 230,
     .block_y_m = 150,
     .jitter = 0.03,
     .bend_m = 2,
     .swirl_m = 15,
     .removed = 0.12,
     .half_width_m = 3.75,
     .main_street_every = 3,
     .main_half_width_m = 7.5,
     .covered_share = 0,
     .highways = true,
     .front_m = {22, 70},
     .depth_m = {18, 50},
     .height_m = {5, 14},
     .setback_m = {6, 20},
     .gap_m = {8, 35},
     .gap_share = 0.95,
     .wing = 0.4,
     .flat_roofs = true,
     .hedge = 0.06,
     .fence = 0.4,
     .tree = 0.15},
    {.name = "estate",  // one street like the other
     .block_x_m = 160,
     .block_y_m = 55,
     .jitter = 0,
     .bend_m = 0,
     .swirl_m = 0,
     .removed = 0,
     .half_width_m = 3.0,
     .main_street_every = 4,
     .main_half_width_m = 7.5,
     .covered_share = 0,
     .highways = true,
     .front_m = {10, 10},
     .depth_m = {9, 9},
     .height_m = {7, 7},
     .setback_m = {4, 4},
     .gap_m = {5, 5},
     .gap_share = 1,
     .wing = 0,
     .flat_roofs = false,
     .hedge = 0.2,
     .fence = 0.6,
     .tree = 0.3},
    {.name = "plaza",  // squares between large houses, and passages under them
     .block_x_m = 45,
     .block_y_m = 38,
     .jitter = 0.02,
     .bend_m = 0,
     .swirl_m = 0,
     .removed = 0.25,
     .half_width_m = 2.6,
     .main_street_every = 4,
     .main_half_width_m = 4.0,
     .covered_share = 0.9,
     .highways = false,
     .front_m = {10, 22},
     .depth_m = {7, 12},
     .height_m = {8, 20},
     .setback_m = {1, 3},
     .gap_m = {3, 12},
     .gap_share = 0.3,
     .wing = 0,
     .flat_roofs = true,
     .hedge = 0.05,
     .fence = 0.05,
     .tree = 0.3},
}};

}  // namespace

const TownStyle& StyleByName(const std::string& name) {
  std::vector<std::string> known;
  for (const TownStyle& style : kStyles) {
    if (style.name == name) return style;
    known.emplace_back(style.name);
  }
  throw std::runtime_error(fmt::format("there is no style of town '{}'; known are {}", name, fmt::join(known, ", ")));
}

}  // namespace mapweld::sim
