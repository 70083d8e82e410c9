// SPDX-License-Identifier: Apache-2.0
// When the vehicle is where on its path: standing, driving as fast as comfort allows, standing again.
#pragma once

#include "tools/sim/lane_path.hpp"
#include "tools/sim/uniform_spline.hpp"

namespace mapweld::sim {

struct DrivingStyle {
  double max_speed_mps = 10;
  double max_accel_mps2 = 1.5;
  double max_lateral_accel_mps2 = 2.0;
  double stand_at_start_s = 3;
  double stand_at_end_s = 2;
};

// Travelled length s (m) over time since the start (s); twice continuously differentiable, never backwards.
UniformSpline<1> PlanSpeed(const LanePath& path, const DrivingStyle& style);

}  // namespace mapweld::sim
