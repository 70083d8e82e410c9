// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/pair_search.hpp"

#include <algorithm>
#include <cmath>

#include "tools/merge/overlap_search.hpp"
#include "tools/merge/overlap_weight.hpp"

namespace mapweld::merge {
namespace {

using geom::Pose3;

const Keyframe& At(const Drive& drive, int keyframe) {
  return drive.keyframes[static_cast<std::size_t>(keyframe)];
}

// The loop whose transform the others are closest to at their own places.
const Loop& Middle(const Drive& a, const Drive& b, const std::vector<Loop>& loops) {
  const auto between_odometries = [&](const Loop& loop) {
    return geom::Level(At(a, loop.keyframe_a).odom_T_body) * loop.a_T_b *
           geom::Level(At(b, loop.keyframe_b).odom_T_body).Inverse();
  };
  std::size_t best = 0;
  double least = -1;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const Pose3 a_T_b = between_odometries(loops[i]);
    double sum = 0;
    for (const Loop& other : loops) {
      const Pose3 level_a = geom::Level(At(a, other.keyframe_a).odom_T_body);
      const Pose3 level_b = geom::Level(At(b, other.keyframe_b).odom_T_body);
      sum += (level_a * other.a_T_b.t - a_T_b * level_b.t).norm();
    }
    if (least < 0 || sum < least) {
      least = sum;
      best = i;
    }
  }
  return loops[best];
}

}  // namespace

std::vector<Loop> ToLoops(const std::vector<VerifiedLoop>& loops) {
  std::vector<Loop> out;
  for (const VerifiedLoop& loop : loops)
    out.push_back({loop.a, loop.b, loop.a_T_b, loop.overlap_ratio, loop.residual_m, 1});
  std::stable_sort(out.begin(), out.end(), [](const Loop& x, const Loop& y) {
    return std::pair(x.keyframe_a, x.keyframe_b) < std::pair(y.keyframe_a, y.keyframe_b);
  });
  out.erase(std::unique(out.begin(), out.end(),
                        [](const Loop& x, const Loop& y) {
                          return x.keyframe_a == y.keyframe_a && x.keyframe_b == y.keyframe_b;
                        }),
            out.end());
  return out;
}

void Summarise(const std::vector<Drive>& drives, const MergeConfig& config, Overlap* overlap) {
  const Drive& a = drives[static_cast<std::size_t>(overlap->drive_a)];
  const Drive& b = drives[static_cast<std::size_t>(overlap->drive_b)];
  if (overlap->loops.empty()) return;
  double feature_distance_squared = 0;
  int against = 0;
  for (const Loop& loop : overlap->loops) {
    const place::PlaceDescriptor& of_a = At(a, loop.keyframe_a).place.descriptor;
    const place::PlaceDescriptor& of_b = At(b, loop.keyframe_b).place.descriptor;
    feature_distance_squared +=
        2 * static_cast<double>(place::CosineDistance(of_a, of_b)) / static_cast<double>(overlap->loops.size());
    against += std::abs(geom::Yaw(loop.a_T_b.q)) > 2.0 ? 1 : -1;
  }
  overlap->reverse = against > 0;
  overlap->length_m = SharedLength(a, overlap->loops, config.verify);
  overlap->weight = overlap->accepted ? OverlapWeight(feature_distance_squared, overlap->length_m, config.weight) : 0;
  const Loop& middle = Middle(a, b, overlap->loops);
  overlap->a_T_b = geom::Level(At(a, middle.keyframe_a).odom_T_body) * middle.a_T_b *
                   geom::Level(At(b, middle.keyframe_b).odom_T_body).Inverse();
}

PairOutcome SearchPair(const std::vector<Drive>& drives, int a, int b, const Association& association,
                       PreparedCache* submaps, const MergeConfig& config) {
  const Drive& drive_a = drives[static_cast<std::size_t>(a)];
  const Drive& drive_b = drives[static_cast<std::size_t>(b)];
  PairOutcome out;
  out.overlap.drive_a = a;
  out.overlap.drive_b = b;
  out.overlap.test = "no likeness";
  for (const Match& match : association.matches) out.overlap.matches.emplace_back(match.a, match.b);
  out.proposed = !association.matches.empty();
  if (!out.proposed) return out;
  LoopFinder finder(drive_a, a, drive_b, b, submaps, config);
  LookAlikes look_alikes(drive_a, a, drive_b, b, submaps, config);
  const Hypothesis found =
      FindOverlap(&finder, &look_alikes, FindZones(drive_a, drive_b, association.matches, config.zones), config.verify);
  out.asked = finder.asked();
  out.asked.merge(look_alikes.asked());
  out.overlap.accepted = found.test.empty();
  out.overlap.test = found.test.empty() ? "registration" : found.test;
  if (!out.overlap.accepted) return out;
  out.overlap.loops = ToLoops(found.loops);
  out.evidence = found.evidence;
  Summarise(drives, config, &out.overlap);
  return out;
}

PairOutcome SearchPair(const std::vector<Drive>& drives, int a, int b, PreparedCache* submaps,
                       const MergeConfig& config) {
  const DrivePlaces places_a = CollectPlaces(drives[static_cast<std::size_t>(a)]);
  const DrivePlaces places_b = CollectPlaces(drives[static_cast<std::size_t>(b)]);
  return SearchPair(drives, a, b, Associate(places_a, places_b, config.association), submaps, config);
}

}  // namespace mapweld::merge
