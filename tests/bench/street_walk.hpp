// SPDX-License-Identifier: Apache-2.0
// Dice, and a walk through a street grid: what the generators of this folder share.
#pragma once

#include <random>
#include <vector>

#include "core/geom/pose3.hpp"

namespace mapweld::bench {

// The same numbers on every machine.
class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double Uniform() { return (static_cast<double>(random_()) + 0.5) / 4294967296.0; }
  double Between(double low, double high) { return low + (high - low) * Uniform(); }
  int Below(int n) { return static_cast<int>(Uniform() * n); }
  double Normal();
  geom::Pose3 Noise(double sigma_m, double sigma_rad);

 private:
  std::mt19937 random_;
};

geom::Vec6d Sigma(double metres, double radians);

// So many poses 5 m apart, on a lane of its own beside the middle of the street, in a square city of so many blocks of
// 100 m.
std::vector<geom::Pose3> WalkStreets(int poses, int blocks, Dice* dice);

}  // namespace mapweld::bench
