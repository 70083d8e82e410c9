// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/association.hpp"

#include <algorithm>

namespace mapweld::merge {
namespace {

// Drives begin where others ended, and fleets start from one yard. Such a meeting shows a few keyframes only, and
// incomplete ones, whose descriptors may be unlike: it is always proposed, and registration decides.
void AddEnds(const Likeness& likeness, std::vector<Match>* matches) {
  for (const int a : {likeness.rows - 1, 0}) {
    for (const int b : {0, likeness.cols - 1}) {
      Match match;
      match.a = a;
      match.b = b;
      match.ends = true;
      matches->push_back(match);
    }
  }
}

}  // namespace

DrivePlaces CollectPlaces(const Drive& drive) {
  DrivePlaces out;
  out.descriptors = CollectDescriptors(drive);
  out.sketches = MakeSketches(out.descriptors);
  return out;
}

std::vector<Match> ProposeMatches(const Likeness& likeness, const AssociationConfig& config) {
  if (likeness.d.empty()) return {};
  std::vector<Match> found = MatchSequences(likeness, config);
  for (const Match& match : MatchSingles(likeness, config)) found.push_back(match);
  AddEnds(likeness, &found);
  std::vector<Match> matches;
  for (const Match& match : found) {
    const auto known = std::find_if(matches.begin(), matches.end(),
                                    [&](const Match& other) { return other.a == match.a && other.b == match.b; });
    if (known == matches.end()) {
      matches.push_back(match);
    } else {
      known->ends = known->ends || match.ends;
    }
  }
  return matches;
}

bool SketchesAgree(const DrivePlaces& a, const DrivePlaces& b, const AssociationConfig& config, Evidence* evidence) {
  if (std::min(a.descriptors.count, b.descriptors.count) < config.min_sketched_keyframes) return true;
  const int step = config.sketch_step;
  const Likeness likeness = ComputeLikeness(CompareSketches(a.sketches, step, b.sketches));
  *evidence = BestEvidence(likeness, std::max(1, config.max_sequence / step), step);
  return evidence->sequence >= config.min_sketch_sequence || evidence->single >= config.min_sketch_single;
}

Association Associate(const DrivePlaces& a, const DrivePlaces& b, const AssociationConfig& config) {
  Association out;
  if (a.descriptors.count == 0 || b.descriptors.count == 0) return out;
  if (config.sketches && !SketchesAgree(a, b, config, &out.evidence)) return out;
  out.compared = true;
  const Cosines cosines = ComputeCosines(a.descriptors, b.descriptors);
  out.matches = ProposeMatches(ComputeLikeness(cosines), config);
  out.evidence = {};
  for (const Match& match : out.matches) {
    double& best = match.sequence ? out.evidence.sequence : out.evidence.single;
    best = std::max(best, match.score);
  }
  return out;
}

}  // namespace mapweld::merge
