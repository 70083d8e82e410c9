// SPDX-License-Identifier: Apache-2.0
// What a merge may keep for the next one, so that only pairs with news are searched again. The answer is the same as
// without it. One cache serves one configuration and drives that only grow.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/merge/pair_search.hpp"
#include "tools/merge/refine.hpp"

namespace mapweld::merge {

class MergeCache {
 public:
  // The outcome for drives[a] and drives[b] if neither has grown and every submap it asked for is there or missing as
  // it was then.
  std::optional<PairOutcome> FindPair(const std::vector<Drive>& drives, int a, int b, PreparedCache* submaps) const;
  void StorePair(const std::vector<Drive>& drives, const PairOutcome& outcome);

  // The same for refinement, which also depends on the poses it started from.
  struct RefineInput {
    std::vector<geom::Pose3> merged_T_a;
    std::vector<geom::Pose3> merged_T_b;
    std::vector<Loop> known;
  };
  std::optional<PairRefinement> FindRefinement(const std::vector<Drive>& drives, int a, int b, int round,
                                               const RefineInput& input, PreparedCache* submaps) const;
  void StoreRefinement(const std::vector<Drive>& drives, int a, int b, int round, RefineInput input,
                       const PairRefinement& refinement);

 private:
  using Names = std::pair<std::string, std::string>;
  struct Pair {
    std::size_t keyframes_a = 0;
    std::size_t keyframes_b = 0;
    PairOutcome outcome;
  };
  struct Refinement {
    RefineInput input;
    PairRefinement result;
  };
  std::map<Names, Pair> pairs_;
  std::map<std::pair<Names, int>, Refinement> refinements_;
};

}  // namespace mapweld::merge
