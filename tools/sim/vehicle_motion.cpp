// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/vehicle_motion.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {
namespace {

constexpr double kStep_s = 0.01;

// A damped spring that follows a target, advanced in small even steps.
class Spring {
 public:
  double Follow(double target) {
    constexpr double kOmega = 2 * std::numbers::pi * 1.4;  // rad/s, a car's body on its springs
    constexpr double kDamping = 0.45;
    rate_ += kStep_s * (kOmega * kOmega * (target - value_) - 2 * kDamping * kOmega * rate_);
    value_ += kStep_s * rate_;
    return value_;
  }

 private:
  double value_ = 0;
  double rate_ = 0;
};

// Shaking by the road: a few tones, stronger the faster the vehicle drives.
struct Tone {
  std::size_t channel;  // of the state: 2 z, 3 roll, 4 pitch
  double frequency_hz;
  double amplitude;  // m or rad at 10 m/s
};
constexpr std::array<Tone, 7> kTones{{{2, 1.3, 4e-3},
                                      {2, 2.9, 1.2e-3},
                                      {2, 11.0, 1.2e-4},
                                      {3, 0.9, 3e-3},
                                      {3, 2.3, 0.8e-3},
                                      {4, 1.1, 2.5e-3},
                                      {4, 3.7, 0.4e-3}}};

UniformSpline<6> BuildState(const LanePath& path, const DrivingStyle& style, const Relief& relief, std::uint64_t seed) {
  constexpr double kPitchPerAccel = -0.008;       // rad per m/s^2: braking dips the nose, and nose down is positive
  constexpr double kRollPerLateralAccel = 0.010;  // rad per m/s^2: a left bend leans the body to the right
  const UniformSpline<1> travelled = PlanSpeed(path, style);
  const auto n = static_cast<std::size_t>(std::floor(travelled.end() / kStep_s));
  std::array<double, kTones.size()> phase{};
  for (std::size_t k = 0; k < kTones.size(); ++k) phase[k] = Uniform(Hash(seed, 0x70E, k), 0, 2 * std::numbers::pi);
  Spring pitch;
  Spring roll;
  std::vector<UniformSpline<6>::Vector> control;
  control.reserve(n + 1);
  for (std::size_t i = 0; i <= n; ++i) {
    const double t = static_cast<double>(i) * kStep_s;
    const double s = travelled.Value(t).x();
    const double speed = travelled.Derivative(t).x();
    const double accel = travelled.SecondDerivative(t).x();
    UniformSpline<6>::Vector state;
    const Vec2d at = path.Position(s);
    const double heading = path.Heading(s);
    // The road under the wheels: uphill lifts the nose, ground that rises to the left leans the body to the right.
    const Vec2d slope = relief.StreetSlope(at);
    const double uphill = slope.dot(Vec2d(std::cos(heading), std::sin(heading)));
    const double left_up = slope.dot(Vec2d(-std::sin(heading), std::cos(heading)));
    state << at, kBodyHeight_m + relief.StreetHeight(at),
        std::atan(left_up) + roll.Follow(kRollPerLateralAccel * speed * speed * path.Curvature(s)),
        -std::atan(uphill) + pitch.Follow(kPitchPerAccel * accel), heading;
    for (std::size_t k = 0; k < kTones.size(); ++k) {
      state[static_cast<Eigen::Index>(kTones[k].channel)] +=
          kTones[k].amplitude * speed / 10 * std::sin(2 * std::numbers::pi * kTones[k].frequency_hz * t + phase[k]);
    }
    control.push_back(state);
  }
  return {std::move(control), kStep_s};
}

geom::Quatd Orientation(const UniformSpline<6>::Vector& state) {
  using Eigen::AngleAxisd;
  return geom::Quatd(AngleAxisd(state[5], geom::Vec3d::UnitZ()) * AngleAxisd(state[4], geom::Vec3d::UnitY()) *
                     AngleAxisd(state[3], geom::Vec3d::UnitX()));
}

}  // namespace

VehicleMotion::VehicleMotion(const LanePath& path, const DrivingStyle& style, const Relief& relief, std::uint64_t seed)
    : state_(BuildState(path, style, relief, seed)) {}

geom::Pose3 VehicleMotion::WorldFromBody(double t) const {
  const auto state = state_.Value(t);
  return {state.head<3>(), Orientation(state)};
}

geom::Vec3d VehicleMotion::VelocityWorld(double t) const {
  return state_.Derivative(t).head<3>();
}

geom::Vec3d VehicleMotion::AccelWorld(double t) const {
  return state_.SecondDerivative(t).head<3>();
}

geom::Vec3d VehicleMotion::GyroBody(double t) const {
  const auto state = state_.Value(t);
  const auto rate = state_.Derivative(t);
  const double sr = std::sin(state[3]);
  const double cr = std::cos(state[3]);
  const double sp = std::sin(state[4]);
  const double cp = std::cos(state[4]);
  return {rate[3] - rate[5] * sp, rate[4] * cr + rate[5] * sr * cp, -rate[4] * sr + rate[5] * cr * cp};
}

geom::Vec3d VehicleMotion::AccelBody(double t) const {
  const geom::Vec3d force_world = AccelWorld(t) + geom::Vec3d(0, 0, kGravity_mps2);
  return Orientation(state_.Value(t)).conjugate() * force_world;
}

}  // namespace mapweld::sim
