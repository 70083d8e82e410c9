// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/crew.hpp"

#include <mutex>

#include "tools/merge/parallel.hpp"

namespace mapweld::merge {

template <class Result>
std::vector<Result> ThreadCrew::DoAll(const char* stage, int count, const Job<Result>& job) {
  std::vector<Result> results(static_cast<std::size_t>(count));
  int done = 0;
  std::mutex report;
  ParallelFor(count, threads_, [&](int i) {
    results[static_cast<std::size_t>(i)] = job(i);
    if (progress_ == nullptr) return;
    const std::lock_guard lock(report);
    progress_->Report(stage, ++done, count);
  });
  return results;
}

std::vector<std::vector<Association>> ThreadCrew::Do(const char* stage, int count,
                                                     const Job<std::vector<Association>>& job) {
  return DoAll(stage, count, job);
}
std::vector<PairOutcome> ThreadCrew::Do(const char* stage, int count, const Job<PairOutcome>& job) {
  return DoAll(stage, count, job);
}
std::vector<PairRefinement> ThreadCrew::Do(const char* stage, int count, const Job<PairRefinement>& job) {
  return DoAll(stage, count, job);
}
std::vector<GroupSolution> ThreadCrew::Do(const char* stage, int count, const Job<GroupSolution>& job) {
  return DoAll(stage, count, job);
}

}  // namespace mapweld::merge
