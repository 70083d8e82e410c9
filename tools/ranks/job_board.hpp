// SPDX-License-Identifier: Apache-2.0
// Which jobs of one stage are to be done, by whom they were taken, and what came back. Whoever has nothing to do while
// results are outstanding does one of those again: so what a lost rank had taken is done by another, without anybody
// having to notice that it is lost.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tools/store/database.hpp"

namespace mapweld::ranks {

class JobBoard {
 public:
  explicit JobBoard(int jobs);
  // The job to do next: one that nobody took, else the outstanding one taken least often, the lowest of those; nothing
  // when all are done. Cost: linear in the jobs once all were taken.
  std::optional<int> Take();
  // False for a result that was there already, which changes nothing. Throws std::out_of_range for no such job.
  bool Put(int job, store::Bytes result);
  [[nodiscard]] bool AllDone() const { return done_ == static_cast<int>(jobs_.size()); }
  [[nodiscard]] int done() const { return done_; }
  // All results by job; only when all are done.
  [[nodiscard]] std::vector<store::Bytes> Results() &&;

 private:
  struct JobState {
    int taken = 0;
    bool done = false;
    store::Bytes result;
  };
  std::vector<JobState> jobs_;
  std::size_t next_ = 0;
  int done_ = 0;
};

}  // namespace mapweld::ranks
