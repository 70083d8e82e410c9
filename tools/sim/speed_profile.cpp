// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/speed_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace mapweld::sim {
namespace {

constexpr double kStep_m = 0.5;
constexpr double kStep_s = 0.1;
// The smoothing below mixes neighbouring moments, so the plan stays this far under the limits.
constexpr double kReserve = 0.85;

// Speeds at even steps of s: the largest that keep all limits.
std::vector<double> SpeedLimits(const LanePath& path, const DrivingStyle& style, double step_m) {
  const auto n = static_cast<std::size_t>(std::lround(path.length_m() / step_m));
  std::vector<double> speed(n + 1);
  for (std::size_t i = 0; i <= n; ++i) {
    const double curvature = std::abs(path.Curvature(static_cast<double>(i) * step_m));
    speed[i] =
        std::min(style.max_speed_mps, std::sqrt(kReserve * style.max_lateral_accel_mps2 / std::max(curvature, 1e-6)));
  }
  speed.front() = 0;
  speed.back() = 0;
  const double gain = 2 * kReserve * style.max_accel_mps2 * step_m;  // of the squared speed over one step
  for (std::size_t i = 1; i <= n; ++i) speed[i] = std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + gain));
  for (std::size_t i = n; i-- > 0;) speed[i] = std::min(speed[i], std::sqrt(speed[i + 1] * speed[i + 1] + gain));
  return speed;
}

// s at even steps of time, constant acceleration within each step of s.
std::vector<double> Integrate(const std::vector<double>& speed, double step_m) {
  std::vector<double> travelled;
  double t_begin = 0;
  double t_next = 0;
  for (std::size_t i = 0; i + 1 < speed.size(); ++i) {
    const double duration = 2 * step_m / (speed[i] + speed[i + 1]);
    const double accel = (speed[i + 1] - speed[i]) / duration;
    for (; t_next < t_begin + duration; t_next += kStep_s) {
      const double u = t_next - t_begin;
      travelled.push_back(static_cast<double>(i) * step_m + speed[i] * u + 0.5 * accel * u * u);
    }
    t_begin += duration;
  }
  travelled.push_back(static_cast<double>(speed.size() - 1) * step_m);
  return travelled;
}

// Hann window over 1 s: turns steps of the acceleration into ramps.
constexpr std::ptrdiff_t kReach = 5;
std::array<double, 2 * kReach + 1> HannWindow() {
  std::array<double, 2 * kReach + 1> w{};
  double sum = 0;
  for (std::size_t i = 0; i < w.size(); ++i) {
    const double s = std::sin(3.14159265358979 * static_cast<double>(i + 1) / static_cast<double>(w.size() + 1));
    w[i] = s * s;
    sum += w[i];
  }
  for (double& x : w) x /= sum;
  return w;
}

}  // namespace

UniformSpline<1> PlanSpeed(const LanePath& path, const DrivingStyle& style) {
  const double step_m = path.length_m() / std::round(path.length_m() / kStep_m);
  const std::vector<double> driving = Integrate(SpeedLimits(path, style, step_m), step_m);
  const auto before = static_cast<std::ptrdiff_t>(std::lround(style.stand_at_start_s / kStep_s)) + kReach + 1;
  const auto after = static_cast<std::ptrdiff_t>(std::lround(style.stand_at_end_s / kStep_s)) + kReach + 1;
  const auto n = static_cast<std::ptrdiff_t>(driving.size());
  const auto window = HannWindow();
  std::vector<UniformSpline<1>::Vector> control;
  for (std::ptrdiff_t i = -before; i < n + after; ++i) {
    double s = 0;
    for (std::ptrdiff_t k = -kReach; k <= kReach; ++k) {
      s += window[static_cast<std::size_t>(k + kReach)] *
           driving[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i + k, 0, n - 1))];
    }
    control.emplace_back(s);
  }
  return {std::move(control), kStep_s};
}

}  // namespace mapweld::sim
