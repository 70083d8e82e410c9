// SPDX-License-Identifier: Apache-2.0
// Maps are drawn to half a metre or so, and some houses end up with a corner on the carriageway. Vehicles must not
// drive through them.
#pragma once

#include "tools/sim/osm_town.hpp"

namespace mapweld::sim {

// Moves every house that reaches closer to a street than its carriageway and a narrow kerb straight away from it. A
// house that a street runs through, an archway, stays where it is. About buildings * road pieces cheap tests.
void MoveHousesOffStreets(Town& town);

}  // namespace mapweld::sim
