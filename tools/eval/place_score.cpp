// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/place_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "tools/merge/parallel.hpp"

namespace mapweld::eval {
namespace {

constexpr int kNever = std::numeric_limits<int>::max();
constexpr std::size_t kRadii = kHitRadii_m.size();
constexpr std::size_t kViews = 4;  // all candidates, and those of each direction
constexpr double kWidest_m = kHitRadii_m.back();

struct Candidate {
  float distance;
  int index;
  double metres;
  Direction direction;
};

bool Nearer(const Candidate& a, const Candidate& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
}

// Whether a candidate is part of view 0 (all) or 1 + Direction.
bool IsSeen(const Candidate& c, std::size_t view) {
  return view == 0 || c.metres > kWidest_m || static_cast<std::size_t>(c.direction) + 1 == view;
}

struct QueryOutcome {
  bool asked = false;                                  // there were candidates
  std::array<std::array<int, kViews>, kRadii> rank{};  // of the first hit; 0: nothing to find, kNever: not comparable
  std::array<BestMatch, kRadii> best;
};

// The place of the first hit in the list of candidates sorted by distance.
int RankOfFirstHit(const std::vector<Candidate>& candidates, std::size_t view, double radius_m) {
  const Candidate* first = nullptr;
  for (const Candidate& c : candidates) {
    const bool hit = c.metres <= radius_m && (view == 0 || static_cast<std::size_t>(c.direction) + 1 == view);
    if (hit && (first == nullptr || Nearer(c, *first))) first = &c;
  }
  if (first == nullptr) return 0;
  if (!std::isfinite(first->distance)) return kNever;
  int rank = 1;
  for (const Candidate& c : candidates) rank += IsSeen(c, view) && Nearer(c, *first) ? 1 : 0;
  return rank;
}

QueryOutcome Ask(const PlaceSet& set, const std::function<float(int, int)>& distance, int query,
                 std::vector<Candidate>* candidates) {
  candidates->clear();
  for (int j = 0; j < set.size(); ++j) {
    if (set.IsCandidate(query, j)) {
      candidates->push_back({distance(query, j), j, set.Metres(query, j), set.DirectionBetween(query, j)});
    }
  }
  QueryOutcome outcome;
  if (candidates->empty()) return outcome;
  outcome.asked = true;
  const Candidate& nearest = *std::min_element(candidates->begin(), candidates->end(), Nearer);
  for (std::size_t r = 0; r < kRadii; ++r) {
    for (std::size_t v = 0; v < kViews; ++v) outcome.rank[r][v] = RankOfFirstHit(*candidates, v, kHitRadii_m[r]);
    outcome.best[r] = {nearest.distance, nearest.metres <= kHitRadii_m[r], outcome.rank[r][0] != 0};
  }
  return outcome;
}

Recall RecallOf(const std::vector<QueryOutcome>& outcomes, std::size_t radius, std::size_t view) {
  Recall recall;
  std::array<int, kRecallRanks.size()> found{};
  for (const QueryOutcome& outcome : outcomes) {
    const int rank = outcome.rank[radius][view];
    if (rank == 0) continue;
    ++recall.queries;
    for (std::size_t n = 0; n < found.size(); ++n) found[n] += rank <= kRecallRanks[n] ? 1 : 0;
  }
  for (std::size_t n = 0; n < found.size() && recall.queries > 0; ++n) {
    recall.at[n] = static_cast<double>(found[n]) / recall.queries;
  }
  return recall;
}

}  // namespace

void ScoreMatches(std::vector<BestMatch> matches, RadiusScore* score) {
  const auto revisits = static_cast<double>(
      std::count_if(matches.begin(), matches.end(), [](const BestMatch& m) { return m.revisited; }));
  std::erase_if(matches, [](const BestMatch& m) { return !std::isfinite(m.distance); });
  if (revisits == 0 || matches.empty()) return;
  std::sort(matches.begin(), matches.end(),
            [](const BestMatch& a, const BestMatch& b) { return a.distance < b.distance; });
  double right = 0;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    right += matches[i].hit ? 1 : 0;
    if (i + 1 < matches.size() && matches[i + 1].distance == matches[i].distance) continue;
    score->curve.push_back({matches[i].distance, right / static_cast<double>(i + 1), right / revisits});
  }
  double recall_at_full_precision = 0;
  PrecisionRecall before{0, score->curve.front().precision, 0};
  for (const PrecisionRecall& point : score->curve) {
    const double sum = point.precision + point.recall;
    if (sum > 0) score->f1_max = std::max(score->f1_max, 2 * point.precision * point.recall / sum);
    if (point.precision == 1) recall_at_full_precision = point.recall;
    score->auc += (point.recall - before.recall) * (point.precision + before.precision) / 2;
    before = point;
  }
  score->extended_precision = (score->curve.front().precision + recall_at_full_precision) / 2;
}

PlaceScore ScorePlaces(const PlaceSet& set, const std::function<float(int, int)>& distance, int threads,
                       merge::Progress* progress) {
  std::vector<QueryOutcome> outcomes(static_cast<std::size_t>(set.size()));
  const int jobs = std::min(set.size(), 200);
  std::mutex report;
  int done = 0;
  merge::ParallelFor(jobs, threads, [&](int job) {
    std::vector<Candidate> candidates;
    for (int i = job; i < set.size(); i += jobs) {
      outcomes[static_cast<std::size_t>(i)] = Ask(set, distance, i, &candidates);
    }
    const std::lock_guard lock(report);
    if (progress != nullptr) progress->Report("comparing", ++done, jobs);
  });
  PlaceScore score;
  for (std::size_t r = 0; r < kRadii; ++r) {
    score[r].radius_m = kHitRadii_m[r];
    score[r].all = RecallOf(outcomes, r, 0);
    for (std::size_t d = 0; d < 3; ++d) score[r].by_direction[d] = RecallOf(outcomes, r, d + 1);
    std::vector<BestMatch> matches;
    for (const QueryOutcome& outcome : outcomes) {
      if (outcome.asked) matches.push_back(outcome.best[r]);
    }
    ScoreMatches(std::move(matches), &score[r]);
  }
  return score;
}

}  // namespace mapweld::eval
