// SPDX-License-Identifier: Apache-2.0
// Three drives that overlap pairwise must close: a to b to c and back to a is the identity, but for the drift of the
// odometry between the loops used.
#pragma once

#include <vector>

#include "tools/merge/merge_config.hpp"
#include "tools/merge/merge_result.hpp"

namespace mapweld::merge {

// Withdraws accepted overlaps (accepted = false, test = "cycle") until every triple closes; each time the one in the
// most broken triples, and of those the one with the fewest loops. Cost: triples times 8^3 combinations of loops.
void CheckCycles(const std::vector<Drive>& drives, const VerifyConfig& config, std::vector<Overlap>* overlaps);

}  // namespace mapweld::merge
