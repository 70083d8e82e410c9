// SPDX-License-Identifier: Apache-2.0
// Which directions of motion does a scan determine? In a corridor it says nothing about the position along it, on an
// open field nothing about x, y and heading.
#pragma once

#include "core/geom/pose3.hpp"

namespace mapweld::lio {

struct DegeneracyConfig {
  double min_position_information = 2.0e3;  // 1/m^2: a direction with less is open; 2000 is 22 mm
  double min_rotation_information = 2.0e5;  // 1/rad^2: 2 mrad
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
// there it is the noise of the normals, not the walls, that speaks. After Zhang, Kaess, Singh, "On degeneracy of
// optimization-based state estimation problems", ICRA 2016, with both blocks apart as their units differ.
Degeneracy RemoveOpenDirections(const DegeneracyConfig& config, geom::Mat6d* information, geom::Vec6d* gradient);

}  // namespace mapweld::lio
