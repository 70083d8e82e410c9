// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/lane_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mapweld::sim {
namespace {

constexpr double kStep_m = 0.5;

// Gaussian smoothing of an evenly spaced line. Beyond the ends the line continues point-mirrored, so the ends stay.
Polyline Smooth(const Polyline& line, double sigma_m) {
  const auto n = static_cast<std::ptrdiff_t>(line.size());
  const auto at = [&](std::ptrdiff_t i) -> Vec2d {
    if (i < 0) return 2 * line.front() - line[static_cast<std::size_t>(std::min(-i, n - 1))];
    if (i >= n) return 2 * line.back() - line[static_cast<std::size_t>(std::max<std::ptrdiff_t>(2 * n - 2 - i, 0))];
    return line[static_cast<std::size_t>(i)];
  };
  const double sigma = sigma_m / kStep_m;
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(3 * sigma));
  Polyline out;
  out.reserve(line.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    Vec2d sum = Vec2d::Zero();
    double weights = 0;
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      const double x = static_cast<double>(k) / sigma;
      const double w = std::exp(-0.5 * x * x);
      sum += w * at(i + k);
      weights += w;
    }
    out.emplace_back(sum / weights);
  }
  return out;
}

double CurvatureOf(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  const double product = (b - a).norm() * (c - b).norm() * (c - a).norm();
  return 2 * Cross(b - a, c - b) / std::max(product, 1e-9);
}

// Pulls every point where the line bends too sharply towards the middle of its neighbours until none is left: corners
// become arcs of about the given radius, all else stays. The number of rounds is bounded.
Polyline LimitCurvature(Polyline line, double min_radius_m) {
  constexpr int kMaxRounds = 20000;
  constexpr int kRoundsPerResample = 100;
  for (int round = 0; round < kMaxRounds; ++round) {
    bool moved = false;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      if (std::abs(CurvatureOf(line[i - 1], line[i], line[i + 1])) <= 1 / min_radius_m) continue;
      line[i] = 0.5 * line[i] + 0.25 * (line[i - 1] + line[i + 1]);
      moved = true;
    }
    if (!moved) break;
    if (round % kRoundsPerResample == 0) line = Resample(line, kStep_m);
  }
  return Resample(line, kStep_m);
}

// What a driver does with his lane: he flattens every bend as far as half a metre to either side allows.
Polyline UseTheLane(Polyline line) {
  constexpr double kComfortableRadius_m = 40;
  constexpr double kMaxShift_m = 0.45;
  constexpr int kRounds = 2000;
  const Polyline middle = line;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      if (std::abs(CurvatureOf(line[i - 1], line[i], line[i + 1])) <= 1 / kComfortableRadius_m) continue;
      const Vec2d shift = 0.5 * line[i] + 0.25 * (line[i - 1] + line[i + 1]) - middle[i];
      line[i] = middle[i] + shift * std::min(1.0, kMaxShift_m / std::max(shift.norm(), 1e-9));
    }
  }
  return Resample(line, kStep_m);
}

Vec2d Along(const Polyline& line, std::size_t i) {
  return (line[std::min(i + 1, line.size() - 1)] - line[i == 0 ? 0 : i - 1]).normalized();
}

Polyline ToTheRight(const Polyline& line, const LaneHabit& habit) {
  Polyline out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec2d along = Along(line, i);
    const double turn = 2 * std::numbers::pi * kStep_m * static_cast<double>(i) / habit.wave_m + habit.phase_rad;
    const double offset_m = habit.offset_m + habit.wander_m * std::sin(turn);
    out.emplace_back(line[i] + offset_m * Vec2d(along.y(), -along.x()));
  }
  return out;
}

Polyline LaneLine(const Polyline& centreline, const LaneHabit& habit) {
  // The first rounding keeps the inner lane of a sharp corner from folding over itself.
  Polyline line = Smooth(Resample(centreline, kStep_m), 1.0);
  line = LimitCurvature(line, 4.0);
  line = Resample(ToTheRight(line, habit), kStep_m);
  line = UseTheLane(LimitCurvature(line, 1.05 * LanePath::kMinRadius_m));
  return Resample(Smooth(line, 1.5), kStep_m);
}

std::vector<Eigen::Matrix<double, 1, 1>> Headings(const Polyline& line) {
  std::vector<Eigen::Matrix<double, 1, 1>> out;
  double heading = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec2d along = Along(line, i);
    const double wrapped = std::atan2(along.y(), along.x());
    heading = i == 0 ? wrapped : heading + std::remainder(wrapped - heading, 2 * std::numbers::pi);
    out.emplace_back(heading);
  }
  return out;
}

}  // namespace

LanePath LanePath::Beside(const Polyline& centreline, const LaneHabit& habit) {
  const Polyline line = LaneLine(centreline, habit);
  // The last resampling made all steps equal, close to but not exactly kStep_m.
  return {line, Length(line) / static_cast<double>(line.size() - 1)};
}

LanePath::LanePath(const Polyline& even_points, double step_m)
    : position_(even_points, step_m), heading_(Headings(even_points), step_m) {}

double LanePath::Curvature(double s) const {
  const Vec2d d1 = position_.Derivative(s);
  const Vec2d d2 = position_.SecondDerivative(s);
  return Cross(d1, d2) / std::pow(d1.norm(), 3);
}

}  // namespace mapweld::sim
