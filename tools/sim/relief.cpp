// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/relief.hpp"

#include <cmath>
#include <numbers>

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {

Relief::Relief(double amplitude_m, std::uint64_t seed, const std::optional<Cellar>& cellar) : cellar_(cellar) {
  for (std::size_t i = 0; i < waves_.size(); ++i) {
    const auto draw = [&](std::uint64_t what, double low, double high) {
      return Uniform(Hash(seed, 0x4E11EF + i, what), low, high);
    };
    const double direction = draw(1, 0, 2 * std::numbers::pi);
    const double length_m = draw(2, 300, 900);
    waves_[i] = {2 * std::numbers::pi / length_m * Vec2d(std::cos(direction), std::sin(direction)),
                 amplitude_m * std::sqrt(2.0 / static_cast<double>(waves_.size())), draw(3, 0, 2 * std::numbers::pi)};
  }
}

double Relief::Height(const Vec2d& p) const {
  double height = 0;
  for (const Wave& w : waves_) height += w.amplitude_m * std::sin(w.direction_per_m.dot(p) + w.phase);
  return height;
}

Vec2d Relief::Slope(const Vec2d& p) const {
  Vec2d slope = Vec2d::Zero();
  for (const Wave& w : waves_) {
    slope += w.amplitude_m * std::cos(w.direction_per_m.dot(p) + w.phase) * w.direction_per_m;
  }
  return slope;
}

double Relief::StreetHeight(const Vec2d& p) const {
  return Height(p) - (cellar_ ? cellar_->Depth(p) : 0);
}

Vec2d Relief::StreetSlope(const Vec2d& p) const {
  return Slope(p) + (cellar_ ? cellar_->Slope(p) : Vec2d(0, 0));
}

void Relief::Lift(TownMesh* mesh) const {
  for (Mesh& kind : *mesh) kind.Raise([this](const Vec2d& p) { return Height(p); });
}

void Relief::LiftOntoStreet(TownMesh* mesh) const {
  for (Mesh& kind : *mesh) kind.Raise([this](const Vec2d& p) { return StreetHeight(p); });
}

}  // namespace mapweld::sim
