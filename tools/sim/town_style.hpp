// SPDX-License-Identifier: Apache-2.0
// What makes an old town an old town and a suburb a suburb, in numbers.
#pragma once

#include <string>

namespace mapweld::sim {

struct Range {
  double low = 0;
  double high = 0;
};

struct TownStyle {
  const char* name;
  // Streets
  double block_x_m;  // mean distance of parallel streets
  double block_y_m;
  double jitter;          // of the corners, share of a block
  double bend_m;          // sideways, of the middle of a street between two corners
  double swirl_m;         // of whole quarters
  double removed;         // share of the pieces of street that are not there
  double half_width_m;    // of the carriageway
  int main_street_every;  // parallel streets; these are wider
  double main_half_width_m;
  double covered_share;  // of the streets, those that are passages under ground; in one half of the town
  bool highways;         // the main streets are straight roads without houses, between rails and noise barriers
  // Houses
  Range front_m;  // width along the street
  Range depth_m;
  Range height_m;
  Range setback_m;   // from the kerb
  Range gap_m;       // to the next house
  double gap_share;  // of the houses that leave a gap; the others touch
  double wing;       // share of houses with a wing behind
  bool flat_roofs;
  // Gardens
  double hedge;  // share of the plots between kerb and house with a hedge, a fence, a tree
  double fence;
  double tree;
};

// "old_town", "suburb", "industry", "estate", "plaza". Throws std::runtime_error listing them for any other.
const TownStyle& StyleByName(const std::string& name);

}  // namespace mapweld::sim
