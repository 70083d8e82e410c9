// SPDX-License-Identifier: Apache-2.0
// What a merge finds and costs while its drives grow (Fig. 13, 14 and 17 of the AutoMerge paper, doi
// 10.1109/TRO.2023.3290448): the same drives cut off at rising lengths, each merged from nothing.
#pragma once

#include <vector>

#include "tools/describe/keyframe_source.hpp"
#include "tools/merge/merge_result.hpp"
#include "tools/merge/progress.hpp"

namespace mapweld::eval {

struct GrowthStep {
  double longest_m = 0;  // every drive is cut off there
  double path_km = 0;    // of all drives
  int keyframes = 0;
  int groups = 0;
  int zones = 0;         // sets of drives that truly come within 10 m of one another
  int mixed_groups = 0;  // groups with drives of two zones
  int accepted = 0;
  int wrong = 0;       // accepted pairs that never come within 10 m of one another
  int overlaps = 0;    // pairs that share at least 30 m of path
  int found = 0;       // of these, accepted
  double rmse_m = 0;   // of positions, one alignment per group
  double seconds = 0;  // wall clock, all stages
  std::vector<merge::StageTime> stages;
};

// `sources` with true positions in one frame. Cost: one merge per length.
std::vector<GrowthStep> StudyGrowth(const std::vector<describe::KeyframeSource>& sources,
                                    const std::vector<double>& lengths_m, int threads, merge::Progress* progress);

}  // namespace mapweld::eval
