// SPDX-License-Identifier: Apache-2.0
// Maps are drawn to half a metre or so, and some houses end up with a corner on the carriageway. Vehicles must not
// drive through them.
#pragma once

#include "tools/sim/town.hpp"

namespace mapweld::sim {

// Moves every house that reaches closer to a street than its carriageway and a narrow kerb straight away from it. A
// house that a street runs through, an archway, stays where it is.
void MoveHousesOffStreets(Town& town);

// For towns that nobody built: what still stands on a street, a house, a fence or a tree, goes.
void RemoveWhatBlocksStreets(Town* town);

}  // namespace mapweld::sim
