// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/overlap_truth.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>

namespace mapweld::sim {
namespace {

constexpr double kStep_m = 1;

struct Place {
  int drive;
  Vec2d position;
  double heading;
};

std::int64_t Cell(double x, double y) {
  return static_cast<std::int64_t>(std::floor(x / kTogether_m)) * 1'000'003 +
         static_cast<std::int64_t>(std::floor(y / kTogether_m));
}

}  // namespace

std::vector<TrueOverlap> FindTrueOverlaps(const std::vector<LanePath>& drives) {
  std::vector<Place> places;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    for (double s = 0; s <= drives[d].length_m(); s += kStep_m) {
      const Vec2d p = drives[d].Position(s);
      cells[Cell(p.x(), p.y())].push_back(places.size());
      places.push_back({static_cast<int>(d), p, drives[d].Heading(s)});
    }
  }
  std::map<std::pair<int, int>, TrueOverlap> found;
  for (const Place& here : places) {
    struct Nearest {
      double distance_m = std::numeric_limits<double>::infinity();
      double cosine = 0;
    };
    std::map<int, Nearest> nearest;  // by the other drive
    for (const double dx : {-kTogether_m, 0.0, kTogether_m}) {
      for (const double dy : {-kTogether_m, 0.0, kTogether_m}) {
        const auto cell = cells.find(Cell(here.position.x() + dx, here.position.y() + dy));
        if (cell == cells.end()) continue;
        for (const std::size_t i : cell->second) {
          const Place& there = places[i];
          const double distance_m = (there.position - here.position).norm();
          if (there.drive <= here.drive || distance_m > kTogether_m) continue;
          // Of equally near passages the one along the street counts, not the one across it.
          Nearest& n = nearest[there.drive];
          const double cosine = std::cos(there.heading - here.heading);
          const bool along = std::abs(cosine) > 0.5;
          const bool had_along = std::abs(n.cosine) > 0.5;
          if ((along && !had_along) || (along == had_along && distance_m < n.distance_m)) n = {distance_m, cosine};
        }
      }
    }
    for (const auto& [other, n] : nearest) {
      TrueOverlap& overlap = found[{here.drive, other}];
      overlap.a = here.drive;
      overlap.b = other;
      (n.cosine > 0.5    ? overlap.same_direction_m
       : n.cosine < -0.5 ? overlap.opposite_direction_m
                         : overlap.crossing_m) += kStep_m;
    }
  }
  std::vector<TrueOverlap> out;
  for (const auto& [pair, overlap] : found) out.push_back(overlap);
  return out;
}

}  // namespace mapweld::sim
