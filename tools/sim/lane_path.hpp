// SPDX-License-Identifier: Apache-2.0
// The line that a vehicle drives: the right-hand lane beside a street's centre line, corners rounded to what a car can
// steer. Twice continuously differentiable.
#pragma once

#include "tools/sim/polygon.hpp"
#include "tools/sim/uniform_spline.hpp"

namespace mapweld::sim {

// Where between the middle of the street and the kerb somebody drives.
struct LaneHabit {
  double offset_m = 1.75;  // to the right of the centre line, on average
  double wander_m = 0;     // amplitude of a slow wave about it
  double wave_m = 100;     // its length
  double phase_rad = 0;
};

class LanePath {
 public:
  static constexpr double kMinRadius_m = 5.5;

  static LanePath Beside(const Polyline& centreline, const LaneHabit& habit = {});

  // s runs from 0 to length_m() and is the travelled length to within a percent.
  [[nodiscard]] double length_m() const { return position_.end(); }
  [[nodiscard]] Vec2d Position(double s) const { return position_.Value(s); }
  [[nodiscard]] double Heading(double s) const { return heading_.Value(s).x(); }  // rad from east, not wrapped
  [[nodiscard]] double Curvature(double s) const;                                 // 1/m, positive to the left

 private:
  using PositionSpline = UniformSpline<2>;
  using HeadingSpline = UniformSpline<1>;
  LanePath(const Polyline& even_points, double step_m);
  PositionSpline position_;
  HeadingSpline heading_;
};

}  // namespace mapweld::sim
