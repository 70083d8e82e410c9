// SPDX-License-Identifier: Apache-2.0
// Who does the independent jobs of a merge: threads of one process, or processes on many machines (tools/ranks).
//
// Every job is a pure function of its number and of what all members know alike, so any member may do it, and doing it
// twice does no harm: the merge gives the same bytes whoever works.
#pragma once

#include <functional>
#include <vector>

#include "tools/merge/association.hpp"
#include "tools/merge/group_solver.hpp"
#include "tools/merge/pair_search.hpp"
#include "tools/merge/progress.hpp"
#include "tools/merge/refine.hpp"

namespace mapweld::merge {

template <class Result>
using Job = std::function<Result(int)>;

// `Do` calls job(i) for every i in 0..count-1, perhaps at the same time, and gives the results by i. What a job throws
// is thrown again.
class Crew {
 public:
  virtual ~Crew() = default;
  virtual std::vector<std::vector<Association>> Do(const char* stage, int count,
                                                   const Job<std::vector<Association>>& job) = 0;
  virtual std::vector<PairOutcome> Do(const char* stage, int count, const Job<PairOutcome>& job) = 0;
  virtual std::vector<PairRefinement> Do(const char* stage, int count, const Job<PairRefinement>& job) = 0;
  virtual std::vector<GroupSolution> Do(const char* stage, int count, const Job<GroupSolution>& job) = 0;
  // Is this the process that tells the world? Of several processes with one result only one writes it.
  [[nodiscard]] virtual bool Leads() const { return true; }
};

// The threads of this process.
class ThreadCrew final : public Crew {
 public:
  // threads: 0 for all of the machine. progress may be null, and must outlive the crew.
  ThreadCrew(int threads, Progress* progress) : threads_(threads), progress_(progress) {}
  std::vector<std::vector<Association>> Do(const char* stage, int count,
                                           const Job<std::vector<Association>>& job) override;
  std::vector<PairOutcome> Do(const char* stage, int count, const Job<PairOutcome>& job) override;
  std::vector<PairRefinement> Do(const char* stage, int count, const Job<PairRefinement>& job) override;
  std::vector<GroupSolution> Do(const char* stage, int count, const Job<GroupSolution>& job) override;

 private:
  template <class Result>
  std::vector<Result> DoAll(const char* stage, int count, const Job<Result>& job);

  int threads_;
  Progress* progress_;
};

}  // namespace mapweld::merge
