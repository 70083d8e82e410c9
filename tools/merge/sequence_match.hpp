// SPDX-License-Identifier: Apache-2.0
// Lines and single entries of a likeness matrix that stand out.
#pragma once

#include <vector>

#include "tools/merge/likeness.hpp"
#include "tools/merge/merge_config.hpp"

namespace mapweld::merge {

// One candidate: keyframe a of the first drive at the place of keyframe b of the second.
struct Match {
  int a = 0;
  int b = 0;
  double score = 0;       // robust standard deviations above unrelated entries or lines
  bool sequence = false;  // found as part of a line, not alone
  bool reverse = false;   // the line runs backwards in b
  bool ends = false;      // a meeting of the drives' ends
};

// The middles of the best lines, best first: lengths min_sequence, twice that, ... up to max_sequence, speeds 0.8 to
// 1.25, both directions. Cost: 30 running sums per entry, whatever the lengths.
std::vector<Match> MatchSequences(const Likeness& likeness, const AssociationConfig& config);

// Entries that are among the two best of their row and of their column, best first.
std::vector<Match> MatchSingles(const Likeness& likeness, const AssociationConfig& config);

// The score of the best line of `length` rows and of the best entry. row_step: keyframes from one row to the next.
struct Evidence {
  double sequence = 0;
  double single = 0;
};
Evidence BestEvidence(const Likeness& likeness, int length, int row_step);

}  // namespace mapweld::merge
