// SPDX-License-Identifier: Apache-2.0
// Cars along the kerb: others in every drive, more in some streets than in others.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/sim/clearance.hpp"
#include "tools/sim/plots.hpp"
#include "tools/sim/town_mesh.hpp"

namespace mapweld::sim {

// A car on the road's surface; `along` is where it looks. A saloon, an estate car or a van, by the seed.
void AddCar(const Vec2d& centre, const Vec2d& along, std::uint64_t seed, TownMesh& mesh);

// `seed` is the drive's. How full a street is differs from street to street, and from drive to drive.
void AddParkedCars(const std::vector<Plot>& plots, const Clearance& clearance, std::uint64_t seed, TownMesh& mesh);

}  // namespace mapweld::sim
