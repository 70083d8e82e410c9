// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/merge_pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <iterator>
#include <mutex>
#include <set>
#include <stdexcept>

#include "tools/merge/cycle_check.hpp"
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
  std::optional<PairOutcome> known;  // from the last merge
};

class Merge {
 public:
  Merge(const std::vector<Drive>& drives, SubmapSource& submaps, const MergeConfig& config, Progress* progress,
        MergeCache* cache)
      : drives_(drives), config_(config), submaps_(&submaps), progress_(progress), cache_(cache) {}

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
    const std::size_t n = drives_.size();
    places_.resize(n);
    InParallel("association", n, [&](std::size_t i) { places_[i] = CollectPlaces(drives_[i]); });
    std::vector<std::vector<Pair>> found(n);
    InParallel("association", n, [&](std::size_t a) {
      for (std::size_t b = a + 1; b < n; ++b) {
        Pair pair{static_cast<int>(a), static_cast<int>(b), {}, {}};
        if (cache_ != nullptr) pair.known = cache_->FindPair(drives_, pair.a, pair.b, &submaps_);
        if (!pair.known.has_value()) pair.association = Associate(places_[a], places_[b], config_.association);
        if (pair.known.has_value() || !pair.association.matches.empty() || cache_ != nullptr) {
          found[a].push_back(std::move(pair));
        }
      }
    });
    for (std::vector<Pair>& of_drive : found) std::move(of_drive.begin(), of_drive.end(), std::back_inserter(pairs_));
  }

  // Zones and registration, of pairs with matches.
  void SearchPairs() {
    std::vector<PairOutcome> outcomes(pairs_.size());
    InParallel("pairs", pairs_.size(), [&](std::size_t i) {
      Pair& pair = pairs_[i];
      outcomes[i] = pair.known.has_value() ? std::move(*pair.known)
                                           : SearchPair(drives_, pair.a, pair.b, pair.association, &submaps_, config_);
    });
    for (PairOutcome& outcome : outcomes) {
      if (cache_ != nullptr) cache_->StorePair(drives_, outcome);
      NoteMissing(outcome.asked);
      if (!outcome.proposed) continue;
      out_.overlaps.push_back(std::move(outcome.overlap));
      differences_[{out_.overlaps.back().drive_a, out_.overlaps.back().drive_b}] = std::move(outcome.difference);
    }
  }

  void GroupAndSolve() {
    merge::GroupAndSolve(
        drives_, config_,
        [this](std::size_t count, const std::function<void(std::size_t)>& job) { InParallel("groups", count, job); },
        &out_);
  }

  // Loops that the estimate makes visible, between all drives of a group that now come near each other.
  void Refine(int round) {
    std::vector<std::pair<int, int>> pairs;
    for (const std::vector<int>& group : out_.groups) {
      for (std::size_t i = 0; i < group.size(); ++i) {
        for (std::size_t k = i + 1; k < group.size(); ++k) pairs.emplace_back(group[i], group[k]);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<PairRefinement> found(pairs.size());
    InParallel("refine", pairs.size(), [&](std::size_t i) {
      const auto [a, b] = pairs[i];
      const MergeCache::RefineInput input = RefineInputOf(a, b);
      std::optional<PairRefinement> known;
      if (cache_ != nullptr) known = cache_->FindRefinement(drives_, a, b, round, input, &submaps_);
      found[i] = known.has_value()
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
      const auto image = differences_.find({overlap.drive_a, overlap.drive_b});
      if (overlap.accepted && image != differences_.end()) out_.differences.push_back(std::move(image->second));
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
  void InParallel(const char* stage, std::size_t count, const Job& job) {
    int done = 0;
    std::mutex report;
    ParallelFor(static_cast<int>(count), config_.threads, [&](int i) {
      job(static_cast<std::size_t>(i));
      if (progress_ == nullptr) return;
      const std::lock_guard lock(report);
      progress_->Report(stage, ++done, static_cast<int>(count));
    });
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
  Progress* progress_;
  MergeCache* cache_;
  MergeResult out_;
  std::map<std::pair<int, int>, DifferenceMatrix> differences_;
  std::vector<DrivePlaces> places_;  // per drive
  std::vector<Pair> pairs_;          // that are worth a look
  std::set<SubmapKey> missing_;
};

}  // namespace

MergeResult MergeDrives(const std::vector<Drive>& drives, SubmapSource& submaps, const MergeConfig& config,
                        Progress* progress, MergeCache* cache) {
  CheckDrives(drives);
  return Merge(drives, submaps, config, progress, cache).Run();
}

}  // namespace mapweld::merge
