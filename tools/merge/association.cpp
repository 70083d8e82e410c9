// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/association.hpp"

#include <algorithm>

namespace mapweld::merge {

std::vector<Match> Associate(const Distances& distances, const AssociationConfig& config) {
  if (distances.rows == 0 || distances.cols == 0) return {};
  const Likeness likeness = ComputeLikeness(distances);
  std::vector<Match> matches = MatchSequences(likeness, config);
  const auto add = [&](const Match& match) {
    const auto known = std::find_if(matches.begin(), matches.end(),
                                    [&](const Match& other) { return other.a == match.a && other.b == match.b; });
    if (known == matches.end()) {
      matches.push_back(match);
    } else {
      known->ends = known->ends || match.ends;
    }
  };
  for (const Match& match : MatchSingles(likeness, config)) add(match);
  for (const int a : {distances.rows - 1, 0}) {
    for (const int b : {0, distances.cols - 1}) add({a, b, 0, false, false, true});
  }
  return matches;
}

}  // namespace mapweld::merge
