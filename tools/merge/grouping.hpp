// SPDX-License-Identifier: Apache-2.0
// Which drives belong together and where they are: groups by omega, one pose graph per group, and second thoughts.
#pragma once

#include <vector>

#include "tools/merge/crew.hpp"
#include "tools/merge/merge_config.hpp"
#include "tools/merge/merge_result.hpp"

namespace mapweld::merge {

// Sets groups, group_of and merged_T_body of the result, and the weight of every loop, until nothing changes:
// - split: an overlap that the pose graph of its group does not believe is withdrawn (test = "pose graph"), after which
//   the groups may be others;
// - quarantine: a drive of which more overlaps than GraphConfig::quarantine_after were withdrawn, and more than are
//   left, loses these too (test = "quarantine") and stays alone: its odometry or its clock is not to be trusted.
void GroupAndSolve(const std::vector<Drive>& drives, const MergeConfig& config, Crew* crew, MergeResult* result);

// Recall: an overlap that a cycle or the pose graph had withdrawn, between drives that others have brought into one
// group, and most of whose loops fit where these are now, is accepted again (test = "recalled"). True when there was
// one; groups are then to be solved again.
bool RecallOverlaps(const std::vector<Drive>& drives, const MergeConfig& config, MergeResult* result);

}  // namespace mapweld::merge
