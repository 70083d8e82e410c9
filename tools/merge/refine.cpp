// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mapweld::merge {

using geom::Pose3;

PairRefinement RefinePair(const std::vector<Drive>& drives, int a, int b, const std::vector<Pose3>& merged_T_a,
                          const std::vector<Pose3>& merged_T_b, const std::vector<Loop>& known, PreparedCache* submaps,
                          const MergeConfig& config) {
  const Drive& drive_a = drives[static_cast<std::size_t>(a)];
  const Drive& drive_b = drives[static_cast<std::size_t>(b)];
  LoopFinder finder(drive_a, a, drive_b, b, submaps, config);
  PairRefinement out;
  double next_m = 0;
  const auto stride = static_cast<std::size_t>(config.verify.keyframe_stride);
  for (std::size_t i = 0; i < merged_T_a.size(); i += stride) {
    if (drive_a.keyframes[i].path_m < next_m) continue;
    // Every local minimum of the distance along b: b may pass the place more than once.
    const auto distance = [&](std::size_t k) { return (merged_T_b[k].t - merged_T_a[i].t).head<2>().norm(); };
    bool tried = false;
    for (std::size_t k = 0; k < merged_T_b.size(); k += stride) {
      const double here_m = distance(k);
      if (here_m > config.refine.near_m) continue;
      if (k >= stride && distance(k - stride) <= here_m) continue;
      if (k + stride < merged_T_b.size() && distance(k + stride) < here_m) continue;
      tried = true;
      const int ka = static_cast<int>(i);
      const int kb = static_cast<int>(k);
      const bool is_known = std::any_of(
          known.begin(), known.end(), [&](const Loop& loop) { return loop.keyframe_a == ka && loop.keyframe_b == kb; });
      if (is_known) continue;
      const Pose3 predicted = geom::Level(merged_T_a[i]).Inverse() * geom::Level(merged_T_b[k]);
      if (!finder.VolumesMeet(ka, kb, predicted)) continue;
      const LoopTry answer = finder.Check(ka, kb, predicted, config.verify.max_jump_m);
      if (answer.answer == LoopTry::Answer::kSame) {
        out.loops.push_back(answer.loop);
        out.evidence += answer.loop.evidence;
      }
      if (answer.answer == LoopTry::Answer::kDifferent) ++out.contradictions;
    }
    if (tried) next_m = drive_a.keyframes[i].path_m + config.refine.step_m - 0.5;
  }
  out.asked = finder.asked();
  return out;
}

}  // namespace mapweld::merge
