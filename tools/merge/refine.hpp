// SPDX-License-Identifier: Apache-2.0
// Loops that the first optimisation makes visible: every few metres along every stretch where two drives of one group
// now lie on each other, also between drives whose overlap association had missed.
#pragma once

#include <map>
#include <vector>

#include "tools/merge/loop_finder.hpp"
#include "tools/merge/merge_result.hpp"

namespace mapweld::merge {

struct PairRefinement {
  std::vector<VerifiedLoop> loops;  // new ones
  int contradictions = 0;           // pairs of near keyframes that do not fit
  double evidence = 0;
  std::map<SubmapKey, bool> asked;
};

// merged_T_a, merged_T_b: keyframes of both drives in one frame. `known` loops are not tried again.
PairRefinement RefinePair(const std::vector<Drive>& drives, int a, int b, const std::vector<geom::Pose3>& merged_T_a,
                          const std::vector<geom::Pose3>& merged_T_b, const std::vector<Loop>& known,
                          PreparedCache* submaps, const MergeConfig& config);

}  // namespace mapweld::merge
