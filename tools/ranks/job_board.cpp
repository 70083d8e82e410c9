// SPDX-License-Identifier: Apache-2.0
#include "tools/ranks/job_board.hpp"

#include <utility>

namespace mapweld::ranks {

JobBoard::JobBoard(int jobs) : jobs_(static_cast<std::size_t>(jobs)) {}

std::optional<int> JobBoard::Take() {
  if (next_ < jobs_.size()) {
    jobs_[next_].taken = 1;
    return static_cast<int>(next_++);
  }
  JobState* least = nullptr;
  for (JobState& job : jobs_) {
    if (!job.done && (least == nullptr || job.taken < least->taken)) least = &job;
  }
  if (least == nullptr) return std::nullopt;
  ++least->taken;
  return static_cast<int>(least - jobs_.data());
}

bool JobBoard::Put(int job, store::Bytes result) {
  JobState& state = jobs_.at(static_cast<std::size_t>(job));
  if (state.done) return false;
  state.done = true;
  state.result = std::move(result);
  ++done_;
  return true;
}

std::vector<store::Bytes> JobBoard::Results() && {
  std::vector<store::Bytes> out;
  out.reserve(jobs_.size());
  for (JobState& job : jobs_) out.push_back(std::move(job.result));
  return out;
}

}  // namespace mapweld::ranks
