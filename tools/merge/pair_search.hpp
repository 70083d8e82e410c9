// SPDX-License-Identifier: Apache-2.0
// What one pair of drives has in common, from its matches on: zones, registration. Pairs do not depend on each other.
#pragma once

#include <map>

#include "tools/merge/association.hpp"
#include "tools/merge/loop_finder.hpp"
#include "tools/merge/merge_config.hpp"
#include "tools/merge/merge_result.hpp"

namespace mapweld::merge {

struct PairOutcome {
  Overlap overlap;                  // accepted or not, with the loops; weight not yet set
  bool proposed = false;            // association had something to say
  double evidence = 0;              // of the accepted loops, summed
  std::map<SubmapKey, bool> asked;  // submaps wanted, and whether they were there
};

PairOutcome SearchPair(const std::vector<Drive>& drives, int a, int b, const Association& association,
                       PreparedCache* submaps, const MergeConfig& config);
// For one pair alone: its association first.
PairOutcome SearchPair(const std::vector<Drive>& drives, int a, int b, PreparedCache* submaps,
                       const MergeConfig& config);

// Loops in the form of the result; at most one per pair of keyframes.
std::vector<Loop> ToLoops(const std::vector<VerifiedLoop>& loops);

// Sets length, direction, weight (eq. 9) and the transform between the odom frames from the overlap's loops.
void Summarise(const std::vector<Drive>& drives, const MergeConfig& config, Overlap* overlap);

}  // namespace mapweld::merge
