// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/street_walk.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace mapweld::bench {

using geom::Pose3;
using geom::Vec3d;
using geom::Vec6d;

double Dice::Normal() {
  const double radius = std::sqrt(-2 * std::log(Uniform()));
  return radius * std::cos(2 * std::numbers::pi * Uniform());
}

Pose3 Dice::Noise(double sigma_m, double sigma_rad) {
  Vec6d delta;
  for (int i = 0; i < 6; ++i) delta[i] = (i < 3 ? sigma_m : sigma_rad) * Normal();
  return geom::Retract({}, delta);
}

Vec6d Sigma(double metres, double radians) {
  Vec6d out;
  out << metres, metres, metres, radians, radians, radians;
  return out;
}

std::vector<Pose3> WalkStreets(int poses, int blocks, Dice* dice) {
  constexpr double kBlock_m = 100;
  constexpr double kStep_m = 5;
  constexpr int kStepsPerBlock = static_cast<int>(kBlock_m / kStep_m);
  static constexpr std::array<std::array<int, 2>, 4> kWay = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  std::vector<Pose3> out;
  int x = dice->Below(blocks);
  int y = dice->Below(blocks);
  int way = dice->Below(4);
  const double lane_m = 3 * (dice->Uniform() - 0.5);
  int step = 0;
  for (int i = 0; i < poses; ++i, ++step) {
    if (step == kStepsPerBlock) {
      step = 0;
      x += kWay[static_cast<std::size_t>(way)][0];
      y += kWay[static_cast<std::size_t>(way)][1];
      const double turn = dice->Uniform();
      if (turn < 0.4) way = (way + (turn < 0.2 ? 1 : 3)) % 4;
      if (x < 1) way = 0;
      if (x > blocks - 1) way = 2;
      if (y < 1) way = 1;
      if (y > blocks - 1) way = 3;
    }
    const double yaw_rad = way * std::numbers::pi / 2;
    const Vec3d along(std::cos(yaw_rad), std::sin(yaw_rad), 0);
    const Vec3d left(-along.y(), along.x(), 0);
    Vec3d at = kBlock_m * Vec3d(x, y, 0) + step * kStep_m * along + lane_m * left;
    at.z() = 5 * std::sin(at.x() / 500) + 5 * std::cos(at.y() / 333);
    out.push_back({at, geom::ExpSo3({0, 0, yaw_rad})});
  }
  return out;
}

}  // namespace mapweld::bench
