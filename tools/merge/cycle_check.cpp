// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/cycle_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace mapweld::merge {
namespace {

using geom::Pose3;

constexpr std::size_t kLoopsTried = 8;  // per overlap
constexpr double kSlack_m = 6;
constexpr double kSlack_rad = 0.12;
constexpr double kDrift_rad_per_m = 0.0015;

// A loop seen in the direction from `from` to `to`.
struct Hop {
  int from_keyframe = 0;
  int to_keyframe = 0;
  Pose3 from_T_to;
};

std::vector<Hop> Hops(const Overlap& overlap, bool forward) {
  std::vector<Hop> out;
  const std::size_t n = std::min(kLoopsTried, overlap.loops.size());
  for (std::size_t i = 0; i < n; ++i) {
    const Loop& loop = overlap.loops[i * overlap.loops.size() / n];
    out.push_back(forward ? Hop{loop.keyframe_a, loop.keyframe_b, loop.a_T_b}
                          : Hop{loop.keyframe_b, loop.keyframe_a, loop.a_T_b.Inverse()});
  }
  return out;
}

const Keyframe& At(const Drive& drive, int keyframe) {
  return drive.keyframes[static_cast<std::size_t>(keyframe)];
}

Pose3 Along(const Drive& drive, int from, int to) {
  return geom::Level(At(drive, from).odom_T_body).Inverse() * geom::Level(At(drive, to).odom_T_body);
}

double PathBetween(const Drive& drive, int x, int y) {
  return std::abs(At(drive, x).path_m - At(drive, y).path_m);
}

// The way round with the least odometry, in which drift could hide an error.
bool Closes(const Drive& a, const Drive& b, const Drive& c, const std::vector<Hop>& ab, const std::vector<Hop>& bc,
            const std::vector<Hop>& ca, const VerifyConfig& config) {
  double shortest_m = std::numeric_limits<double>::infinity();
  std::array<const Hop*, 3> way{};
  for (const Hop& x : ab) {
    for (const Hop& y : bc) {
      for (const Hop& z : ca) {
        const double path_m = PathBetween(b, x.to_keyframe, y.from_keyframe) +
                              PathBetween(c, y.to_keyframe, z.from_keyframe) +
                              PathBetween(a, z.to_keyframe, x.from_keyframe);
        if (path_m >= shortest_m) continue;
        shortest_m = path_m;
        way = {&x, &y, &z};
      }
    }
  }
  const Pose3 round = way[0]->from_T_to * Along(b, way[0]->to_keyframe, way[1]->from_keyframe) * way[1]->from_T_to *
                      Along(c, way[1]->to_keyframe, way[2]->from_keyframe) * way[2]->from_T_to *
                      Along(a, way[2]->to_keyframe, way[0]->from_keyframe);
  const double turn_slack_rad = kSlack_rad + kDrift_rad_per_m * shortest_m;
  const double slack_m = kSlack_m + 2 * config.drift * shortest_m + 0.5 * kDrift_rad_per_m * shortest_m * shortest_m;
  return std::abs(geom::Yaw(round.q)) < turn_slack_rad && round.t.norm() < slack_m;
}

}  // namespace

void CheckCycles(const std::vector<Drive>& drives, const VerifyConfig& config, std::vector<Overlap>* overlaps) {
  const auto drive = [&](int i) -> const Drive& { return drives[static_cast<std::size_t>(i)]; };
  for (;;) {
    std::map<std::pair<int, int>, std::size_t> accepted;
    for (std::size_t i = 0; i < overlaps->size(); ++i) {
      const Overlap& o = (*overlaps)[i];
      if (o.accepted) accepted[{o.drive_a, o.drive_b}] = i;
    }
    std::vector<int> broken(overlaps->size(), 0);
    for (const auto& [ab, i] : accepted) {
      for (auto at = accepted.upper_bound(ab); at != accepted.end() && at->first.first == ab.first; ++at) {
        const auto bc = accepted.find({ab.second, at->first.second});
        if (bc == accepted.end()) continue;
        const std::size_t k = bc->second;
        const std::size_t l = at->second;
        if (Closes(drive(ab.first), drive(ab.second), drive(at->first.second), Hops((*overlaps)[i], true),
                   Hops((*overlaps)[k], true), Hops((*overlaps)[l], false), config)) {
          continue;
        }
        ++broken[i];
        ++broken[k];
        ++broken[l];
      }
    }
    std::size_t worst = overlaps->size();
    for (std::size_t i = 0; i < overlaps->size(); ++i) {
      if (broken[i] == 0) continue;
      const bool worse = worst == overlaps->size() || broken[i] > broken[worst] ||
                         (broken[i] == broken[worst] && (*overlaps)[i].loops.size() < (*overlaps)[worst].loops.size());
      if (worse) worst = i;
    }
    if (worst == overlaps->size()) return;
    (*overlaps)[worst].accepted = false;
    (*overlaps)[worst].test = "cycle";
    (*overlaps)[worst].weight = 0;
  }
}

}  // namespace mapweld::merge
