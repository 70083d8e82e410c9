// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/merge_pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>

#include "tools/merge/cycle_check.hpp"
#include "tools/merge/difference.hpp"
#include "tools/merge/grouping.hpp"
#include "tools/merge/parallel.hpp"

namespace mapweld::merge {
namespace {

using geom::Pose3;

void CheckDrives(const std::vector<Drive>& drives) {
  std::set<std::string> names;
  for (const Drive& drive : drives) {
    if (!names.insert(drive.name).second) {
      throw std::runtime_error(fmt::format("two drives are called '{}'; give each its own name", drive.name));
    }
    for (std::size_t k = 0; k < drive.keyframes.size(); ++k) {
      if (drive.keyframes[k].odom_T_body.IsValid()) continue;
      throw std::runtime_error(
          fmt::format("drive '{}': the pose of keyframe {} is not a rigid transform", drive.name, k));
    }
  }
}

// A pair of drives on its way from association to registration.
struct Pair {
  int a = 0;
  int b = 0;
  Association association;
};

class Merge {
 public:
  Merge(const std::vector<Drive>& drives, SubmapSource& submaps, const MergeConfig& config, Crew* crew,
        MergeCache* cache)
      : drives_(drives), config_(config), submaps_(&submaps), crew_(crew), cache_(cache) {}

  MergeResult Run() {
    Time("association", [&] { AssociatePairs(); });
    Time("pairs", [&] { SearchPairs(); });
    Time("cycles", [&] { CheckCycles(drives_, config_.verify, &out_.overlaps); });
    Time("groups", [&] { GroupAndSolve(); });
    for (int round = 0; round < config_.refine.rounds; ++round) {
      Time("refine", [&] { Refine(round); });
      Time("groups", [&] { GroupAndSolve(); });
    }
    Time("recall", [&] {
      if (RecallOverlaps(drives_, config_, &out_)) GroupAndSolve();
    });
    Finish();
    return std::move(out_);
  }

 private:
  // Sketches, difference matrices, sequences: every pair of drives on its own, one job per drive and all those after
  // it.
  void AssociatePairs() {
    std::vector<DrivePlaces> places;
    for (const Drive& drive : drives_) places.push_back(CollectPlaces(drive));
    const int n = static_cast<int>(drives_.size());
    FindKnownPairs();
    const auto associations = crew_->Do("association", n, [&](int a) {
      std::vector<Association> with_later;
      for (int b = a + 1; b < n; ++b) {
        with_later.push_back(known_.contains({a, b})
                                 ? Association{}
                                 : Associate(places[static_cast<std::size_t>(a)], places[static_cast<std::size_t>(b)],
                                             config_.association));
      }
      return with_later;
    });
    for (int a = 0; a < n; ++a) {
      for (int b = a + 1; b < n; ++b) {
        const Association& found = associations[static_cast<std::size_t>(a)][static_cast<std::size_t>(b - a - 1)];
        if (!found.matches.empty() || cache_ != nullptr) pairs_.push_back({a, b, found});
      }
    }
  }

  // What the cache still vouches for. To ask it means to look for every submap of the pair: once.
  void FindKnownPairs() {
    if (cache_ == nullptr) return;
    const int n = static_cast<int>(drives_.size());
    std::mutex mutex;
    ParallelFor(n, config_.threads, [&](int a) {
      for (int b = a + 1; b < n; ++b) {
        std::optional<PairOutcome> known = cache_->FindPair(drives_, a, b, &submaps_);
        if (!known.has_value()) continue;
        const std::lock_guard lock(mutex);
        known_.emplace(std::pair(a, b), std::move(*known));
      }
    });
  }

  // Zones and registration, of pairs with matches.
  void SearchPairs() {
    std::vector<PairOutcome> outcomes = crew_->Do("pairs", static_cast<int>(pairs_.size()), [&](int i) -> PairOutcome {
      const Pair& pair = pairs_[static_cast<std::size_t>(i)];
      const auto known = known_.find({pair.a, pair.b});
      return known != known_.end() ? known->second
                                   : SearchPair(drives_, pair.a, pair.b, pair.association, &submaps_, config_);
    });
    for (PairOutcome& outcome : outcomes) {
      if (cache_ != nullptr) cache_->StorePair(drives_, outcome);
      NoteMissing(outcome.asked);
      if (outcome.proposed) out_.overlaps.push_back(std::move(outcome.overlap));
    }
  }

  void GroupAndSolve() { merge::GroupAndSolve(drives_, config_, crew_, &out_); }

  // Loops that the estimate makes visible, between all drives of a group that now come near each other.
  void Refine(int round) {
    std::vector<std::pair<int, int>> pairs;
    for (const std::vector<int>& group : out_.groups) {
      for (std::size_t i = 0; i < group.size(); ++i) {
        for (std::size_t k = i + 1; k < group.size(); ++k) pairs.emplace_back(group[i], group[k]);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    const std::vector<PairRefinement> found =
        crew_->Do("refine", static_cast<int>(pairs.size()), [&](int i) -> PairRefinement {
          const auto [a, b] = pairs[static_cast<std::size_t>(i)];
          const MergeCache::RefineInput input = RefineInputOf(a, b);
          std::optional<PairRefinement> known;
          if (cache_ != nullptr) known = cache_->FindRefinement(drives_, a, b, round, input, &submaps_);
          return known.has_value()
                     ? std::move(*known)
                     : RefinePair(drives_, a, b, input.merged_T_a, input.merged_T_b, input.known, &submaps_, config_);
        });
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [a, b] = pairs[i];
      if (cache_ != nullptr) cache_->StoreRefinement(drives_, a, b, round, RefineInputOf(a, b), found[i]);
      NoteMissing(found[i].asked);
    }
    for (std::size_t i = 0; i < pairs.size(); ++i) AddLoops(pairs[i].first, pairs[i].second, found[i]);
  }

  MergeCache::RefineInput RefineInputOf(int a, int b) {
    const Overlap* overlap = FindOverlap(a, b);
    const bool accepted = overlap != nullptr && overlap->accepted;
    return {out_.merged_T_body[static_cast<std::size_t>(a)], out_.merged_T_body[static_cast<std::size_t>(b)],
            accepted ? overlap->loops : std::vector<Loop>{}};
  }

  // An overlap that was not accepted before needs what every other one needed; refused by cycle or pose graph, it stays
  // so.
  void AddLoops(int a, int b, const PairRefinement& found) {
    if (found.loops.empty()) return;
    Overlap* overlap = FindOverlap(a, b);
    if (overlap == nullptr || !overlap->accepted) {
      const VerifyConfig& verify = config_.verify;
      const auto loops = static_cast<int>(found.loops.size());
      if (loops < verify.min_loops || found.evidence < verify.min_total_evidence) return;
      if (found.contradictions > verify.max_contradiction * (loops + found.contradictions)) return;
      double agreement = 0;
      for (const VerifiedLoop& loop : found.loops) agreement += loop.overlap_ratio;
      if (agreement < verify.min_mean_overlap * loops) return;
      if (overlap == nullptr) {
        out_.overlaps.push_back({});
        overlap = &out_.overlaps.back();
        overlap->drive_a = a;
        overlap->drive_b = b;
      } else if (overlap->test == "cycle" || overlap->test == "pose graph" || overlap->test == "quarantine") {
        return;
      }
      overlap->accepted = true;
      overlap->test = "refinement";
      overlap->loops.clear();
    }
    const std::vector<Loop> added = ToLoops(found.loops);
    overlap->loops.insert(overlap->loops.end(), added.begin(), added.end());
    std::stable_sort(overlap->loops.begin(), overlap->loops.end(), [](const Loop& x, const Loop& y) {
      return std::pair(x.keyframe_a, x.keyframe_b) < std::pair(y.keyframe_a, y.keyframe_b);
    });
    Summarise(drives_, config_, overlap);
    std::stable_sort(out_.overlaps.begin(), out_.overlaps.end(), [](const Overlap& x, const Overlap& y) {
      return std::pair(x.drive_a, x.drive_b) < std::pair(y.drive_a, y.drive_b);
    });
  }

  void Finish() {
    for (const Overlap& overlap : out_.overlaps) {
      if (!overlap.accepted) continue;
      const Drive& a = drives_[static_cast<std::size_t>(overlap.drive_a)];
      const Drive& b = drives_[static_cast<std::size_t>(overlap.drive_b)];
      out_.differences.push_back(ToImage(ComputeCosines(a, b), overlap.drive_a, overlap.drive_b));
    }
    out_.missing.assign(missing_.begin(), missing_.end());
  }

  Overlap* FindOverlap(int a, int b) {
    const auto at = std::find_if(out_.overlaps.begin(), out_.overlaps.end(),
                                 [&](const Overlap& o) { return o.drive_a == a && o.drive_b == b; });
    return at == out_.overlaps.end() ? nullptr : &*at;
  }
  void NoteMissing(const std::map<SubmapKey, bool>& asked) {
    for (const auto& [key, found] : asked) {
      if (!found) missing_.insert(key);
    }
  }

  template <class Job>
  void Time(const char* stage, const Job& job) {
    const auto begin = std::chrono::steady_clock::now();
    job();
    out_.times.push_back({stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()});
  }

  const std::vector<Drive>& drives_;
  const MergeConfig& config_;
  PreparedCache submaps_;
  Crew* crew_;
  MergeCache* cache_;
  MergeResult out_;
  std::map<std::pair<int, int>, PairOutcome> known_;  // from the last merge
  std::vector<Pair> pairs_;                           // that are worth a look
  std::set<SubmapKey> missing_;
};

}  // namespace

MergeResult MergeDrives(const std::vector<Drive>& drives, SubmapSource& submaps, const MergeConfig& config, Crew& crew,
                        MergeCache* cache) {
  CheckDrives(drives);
  return Merge(drives, submaps, config, &crew, cache).Run();
}

MergeResult MergeDrives(const std::vector<Drive>& drives, SubmapSource& submaps, const MergeConfig& config,
                        Progress* progress, MergeCache* cache) {
  ThreadCrew crew(config.threads, progress);
  return MergeDrives(drives, submaps, config, crew, cache);
}

}  // namespace mapweld::merge
