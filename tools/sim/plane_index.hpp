// SPDX-License-Identifier: Apache-2.0
// Things by the squares of the plane that they reach into.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "tools/sim/polygon.hpp"

namespace mapweld::sim {

template <class Thing>
class PlaneIndex {
 public:
  void Add(const Box2& reach, const Thing& thing) {
    for (int x = Cell(reach.low.x()); x <= Cell(reach.high.x()); ++x) {
      for (int y = Cell(reach.low.y()); y <= Cell(reach.high.y()); ++y) cells_[Key(x, y)].push_back(thing);
    }
  }
  // All that may reach `p`, in the order of adding.
  [[nodiscard]] std::span<const Thing> At(const Vec2d& p) const {
    const auto found = cells_.find(Key(Cell(p.x()), Cell(p.y())));
    return found == cells_.end() ? std::span<const Thing>{} : std::span<const Thing>{found->second};
  }

 private:
  static int Cell(double x) { return static_cast<int>(std::floor(x / 40)); }
  static std::int64_t Key(int x, int y) { return static_cast<std::int64_t>(x) * 1'000'003 + y; }
  std::unordered_map<std::int64_t, std::vector<Thing>> cells_;
};

}  // namespace mapweld::sim
