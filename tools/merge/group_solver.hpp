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
  std::vector<double> loop_weight;                      // of the loops that counted, in the order of the overlaps
};

// `group` is sorted. Only accepted overlaps with both drives in the group count.
GroupSolution SolveGroup(const std::vector<Drive>& drives, const std::vector<int>& group,
                         const std::vector<Overlap>& overlaps, const GraphConfig& config);

// Writes the weights of a solution into the loops that it counted.
void SetLoopWeights(const std::vector<int>& group, const GroupSolution& solution, std::vector<Overlap>* overlaps);

// How many loops of the overlap agree with these poses of its drives (per drive and keyframe, in one frame), as the
// solver would judge them.
std::size_t LoopsThatFit(const std::vector<Drive>& drives, const Overlap& overlap,
                         const std::vector<std::vector<geom::Pose3>>& merged_T_body, const GraphConfig& config);

}  // namespace mapweld::merge
