// SPDX-License-Identifier: Apache-2.0
// How well a descriptor recognises places. Definitions with their sources: docs/evaluation.md.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "tools/eval/place_set.hpp"
#include "tools/merge/progress.hpp"

namespace mapweld::eval {

inline constexpr std::array<int, 4> kRecallRanks = {1, 5, 10, 20};
inline constexpr std::array<double, 3> kHitRadii_m = {5, 10, 25};

// Share of the queries with a hit among their nearest 1, 5, 10 and 20 candidates.
struct Recall {
  int queries = 0;
  std::array<double, kRecallRanks.size()> at{};  // 0 without queries
};

// One threshold on the distance: matches up to it are believed.
struct PrecisionRecall {
  double threshold = 0;
  double precision = 0;
  double recall = 0;
};

// For one radius within which two keyframes are one place.
struct RadiusScore {
  double radius_m = 0;
  Recall all;
  // Only revisits of this direction (index: Direction): keyframes within 25 m that were passed in another one are taken
  // away from the candidates, so that they can neither help nor get in the way.
  std::array<Recall, 3> by_direction;
  std::vector<PrecisionRecall> curve;  // from the smallest threshold to the largest
  double f1_max = 0;
  double extended_precision = 0;
  double auc = 0;
};

using PlaceScore = std::array<RadiusScore, kHitRadii_m.size()>;

// `distance(query, candidate)` of keyframes of `set`; infinite: cannot be compared. Called from several threads. Equal
// distances are ranked by index. Cost: one distance per query and candidate.
PlaceScore ScorePlaces(const PlaceSet& set, const std::function<float(int, int)>& distance, int threads,
                       merge::Progress* progress);

// The nearest candidate of each query.
struct BestMatch {
  float distance = 0;
  bool hit = false;        // it is the same place
  bool revisited = false;  // there was one to find
};

// The curve and the three figures of its curve. Matches of infinite distance are never believed.
void ScoreMatches(std::vector<BestMatch> matches, RadiusScore* score);

}  // namespace mapweld::eval
