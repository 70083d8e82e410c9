// SPDX-License-Identifier: Apache-2.0
// How the body moves: pose, rate of turn and specific force at any moment, all derived from one spline, so that a
// perfect integration of the IMU values gives the poses back. Springs let the body pitch under braking, lean in bends
// and shake.
#pragma once

#include <cstdint>

#include "core/geom/pose3.hpp"
#include "tools/sim/lane_path.hpp"
#include "tools/sim/relief.hpp"
#include "tools/sim/speed_profile.hpp"
#include "tools/sim/uniform_spline.hpp"

namespace mapweld::sim {

inline constexpr double kGravity_mps2 = 9.81;
inline constexpr double kBodyHeight_m = 1.5;  // of the IMU above the road

class VehicleMotion {
 public:
  // `seed` chooses the phases of the shaking.
  VehicleMotion(const LanePath& path, const DrivingStyle& style, const Relief& relief, std::uint64_t seed);

  // Times t are seconds since the start; standing still before and after.
  [[nodiscard]] double duration_s() const { return state_.end(); }
  [[nodiscard]] geom::Pose3 WorldFromBody(double t) const;  // world: x east, y north, z up
  [[nodiscard]] geom::Vec3d VelocityWorld(double t) const;
  [[nodiscard]] geom::Vec3d AccelWorld(double t) const;
  [[nodiscard]] geom::Vec3d GyroBody(double t) const;   // rad/s
  [[nodiscard]] geom::Vec3d AccelBody(double t) const;  // m/s^2, specific force: (0, 0, 9.81) at rest

 private:
  UniformSpline<6> state_;  // x, y, z, roll, pitch, yaw; orientation = Rz(yaw) Ry(pitch) Rx(roll)
};

}  // namespace mapweld::sim
