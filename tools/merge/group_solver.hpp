// SPDX-License-Identifier: Apache-2.0
// The pose graph of one group of drives: one node per keyframe, odometry along each drive, the loops of the accepted
// overlaps between them. The group's frame is the odom frame of its first drive, held at that drive's first keyframe.
#pragma once

#include <vector>

#include "tools/merge/merge_config.hpp"
#include "tools/merge/merge_result.hpp"

namespace mapweld::merge {

struct GroupSolution {
  std::vector<std::vector<geom::Pose3>> merged_T_body;  // per drive of the group, per keyframe
};

// `group` is sorted. Writes the weight of every loop used into `overlaps`. Only accepted overlaps with both drives in
// the group count.
GroupSolution SolveGroup(const std::vector<Drive>& drives, const std::vector<int>& group, const GraphConfig& config,
                         std::vector<Overlap>* overlaps);

// How many loops of the overlap agree with these poses of its drives (per drive and keyframe, in one frame), as the
// solver would judge them.
std::size_t LoopsThatFit(const std::vector<Drive>& drives, const Overlap& overlap,
                         const std::vector<std::vector<geom::Pose3>>& merged_T_body, const GraphConfig& config);

}  // namespace mapweld::merge
