// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/plots.hpp"

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {

std::vector<Plot> PlotsAlongStreets(const Town& town, const Sight& sight) {
  std::vector<Plot> plots;
  for (const Road& road : town.roads) {
    if (!road.street || !road.furnished || Length(road.line) < kPlot_m) continue;
    const auto id = static_cast<std::uint64_t>(road.id);
    const Polyline line = Resample(road.line, kPlot_m);
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Vec2d middle = (line[i] + line[i - 1]) / 2;
      if (!sight.Contains(middle)) continue;
      const Vec2d along = (line[i] - line[i - 1]).normalized();
      for (const double side : {1.0, -1.0}) {
        plots.push_back({middle, along, side * Vec2d(-along.y(), along.x()), road.half_width_m,
                         Hash(id, i, side > 0 ? 1 : 2), Hash(id, 0x57EE7), static_cast<int>(i)});
      }
    }
  }
  return plots;
}

}  // namespace mapweld::sim
