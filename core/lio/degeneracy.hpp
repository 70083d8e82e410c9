// SPDX-License-Identifier: Apache-2.0
// Which directions of motion does a scan determine? In a corridor it says nothing about the position along it, on an
// open field nothing about x, y and heading.
#pragma once

#include "core/geom/pose3.hpp"

namespace mapweld::lio {

struct DegeneracyConfig {
  double min_position_information = 300;    // 1/m^2: a direction with less is open; 300 is 58 mm
  double min_rotation_information = 2.0e5;  // 1/rad^2: 2 mrad
  double min_over_noise = 3;                // so many times what the noise of the normals pretends to know
};

// The information that planes seem to give about motion along themselves, because their normals are a little off: a
// bound that holds for every direction.
struct NormalNoise {
  double position = 0;                         // 1/m^2
  geom::Mat3d rotation = geom::Mat3d::Zero();  // 1/rad^2
};

// Smallest eigenvalues of the two diagonal blocks and how many directions are open.
struct Degeneracy {
  double position_information = 0;  // 1/m^2
  double rotation_information = 0;  // 1/rad^2
  int open_positions = 0;
  int open_rotations = 0;
  [[nodiscard]] bool any() const { return open_positions + open_rotations > 0; }
};

// Takes from information and gradient (position, then rotation) what a scan claims to know of its open directions:
// there it is the noise of the normals, not the walls, that speaks. Weak evidence above that noise stays: a country
// road has little beside it, and a hundred scans of little are much. After Zhang, Kaess, Singh, "On degeneracy of
// optimization-based state estimation problems", ICRA 2016, with both blocks apart as their units differ and a limit
// that follows the noise.
Degeneracy RemoveOpenDirections(const DegeneracyConfig& config, const NormalNoise& noise, geom::Mat6d* information,
                                geom::Vec6d* gradient);

}  // namespace mapweld::lio
