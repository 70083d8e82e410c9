// SPDX-License-Identifier: Apache-2.0
// Which of the submaps that a merge lacks it should get first.
#pragma once

#include <vector>

#include "tools/merge/merge_cache.hpp"
#include "tools/merge/merge_result.hpp"

namespace mapweld::serve {

// result.missing, most valuable first. A submap is worth what is to be expected of the best pair of drives that wants
// it: the likeness of the two drives where they are most alike, by their descriptors, doubled while they are in
// different groups, because then a whole group is to be won. Within a pair the keyframes that are most alike come
// first. What no pair search wants (refinement does) comes last. Cost: the cosines of every pair that wants some.
std::vector<merge::SubmapKey> ByValue(const std::vector<merge::Drive>& drives, const merge::MergeResult& result,
                                      const merge::MergeCache& cache, merge::SubmapSource* submaps);

}  // namespace mapweld::serve
