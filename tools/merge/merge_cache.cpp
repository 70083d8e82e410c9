// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/merge_cache.hpp"

#include <algorithm>

namespace mapweld::merge {
namespace {

std::pair<std::string, std::string> NamesOf(const std::vector<Drive>& drives, int a, int b) {
  return {drives[static_cast<std::size_t>(a)].name, drives[static_cast<std::size_t>(b)].name};
}

std::map<SubmapKey, bool> Renumber(const std::map<SubmapKey, bool>& asked, int from_a, int to_a, int to_b) {
  std::map<SubmapKey, bool> out;
  for (const auto& [key, found] : asked) out[{key.drive == from_a ? to_a : to_b, key.keyframe}] = found;
  return out;
}

bool SameAvailability(const std::map<SubmapKey, bool>& asked, PreparedCache* submaps) {
  return std::all_of(asked.begin(), asked.end(),
                     [&](const auto& entry) { return submaps->Has(entry.first) == entry.second; });
}

bool Same(const std::vector<geom::Pose3>& x, const std::vector<geom::Pose3>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const geom::Pose3& p, const geom::Pose3& q) {
    return p.t == q.t && p.q.coeffs() == q.q.coeffs();
  });
}

bool Same(const std::vector<Loop>& x, const std::vector<Loop>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const Loop& p, const Loop& q) {
    return p.keyframe_a == q.keyframe_a && p.keyframe_b == q.keyframe_b;
  });
}

}  // namespace

std::optional<PairOutcome> MergeCache::FindPair(const std::vector<Drive>& drives, int a, int b,
                                                PreparedCache* submaps) const {
  const auto at = pairs_.find(NamesOf(drives, a, b));
  if (at == pairs_.end()) return std::nullopt;
  const Pair& pair = at->second;
  if (pair.keyframes_a != drives[static_cast<std::size_t>(a)].keyframes.size()) return std::nullopt;
  if (pair.keyframes_b != drives[static_cast<std::size_t>(b)].keyframes.size()) return std::nullopt;
  PairOutcome out = pair.outcome;
  out.asked = Renumber(pair.outcome.asked, pair.outcome.overlap.drive_a, a, b);
  if (!SameAvailability(out.asked, submaps)) return std::nullopt;
  out.overlap.drive_a = a;
  out.overlap.drive_b = b;
  return out;
}

void MergeCache::StorePair(const std::vector<Drive>& drives, const PairOutcome& outcome) {
  const int a = outcome.overlap.drive_a;
  const int b = outcome.overlap.drive_b;
  pairs_[NamesOf(drives, a, b)] = {drives[static_cast<std::size_t>(a)].keyframes.size(),
                                   drives[static_cast<std::size_t>(b)].keyframes.size(), outcome};
}

std::optional<PairRefinement> MergeCache::FindRefinement(const std::vector<Drive>& drives, int a, int b, int round,
                                                         const RefineInput& input, PreparedCache* submaps) const {
  const auto at = refinements_.find({NamesOf(drives, a, b), round});
  if (at == refinements_.end()) return std::nullopt;
  const RefineInput& then = at->second.input;
  if (!Same(then.merged_T_a, input.merged_T_a) || !Same(then.merged_T_b, input.merged_T_b)) return std::nullopt;
  if (!Same(then.known, input.known)) return std::nullopt;
  PairRefinement out = at->second.result;
  out.asked = Renumber(out.asked, 0, a, b);
  if (!SameAvailability(out.asked, submaps)) return std::nullopt;
  return out;
}

void MergeCache::StoreRefinement(const std::vector<Drive>& drives, int a, int b, int round, RefineInput input,
                                 const PairRefinement& refinement) {
  Refinement& to = refinements_[{NamesOf(drives, a, b), round}];
  to.input = std::move(input);
  to.result = refinement;
  to.result.asked = Renumber(refinement.asked, a, 0, 1);
}

}  // namespace mapweld::merge
