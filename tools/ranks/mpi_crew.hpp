// SPDX-License-Identifier: Apache-2.0
// A merge by many processes under MPI. Every rank has opened the same drives and runs the same merge; at each stage
// rank 0 hands out the jobs one by one, gathers the results and gives all of them to every rank, so that all go on from
// the same state. A rank that dies is not missed: its job is done by another (job_board.hpp), if the launcher lets the
// others live (mpirun --enable-recovery). Without rank 0 nothing goes on.
#pragma once

#include <mpi.h>

#include <cstdint>
#include <list>
#include <span>
#include <utility>
#include <vector>

#include "tools/merge/crew.hpp"
#include "tools/ranks/job_board.hpp"

namespace mapweld::ranks {

// MPI from its start to its end, however many ranks are left then.
class Mpi {
 public:
  Mpi(int* argc, char*** argv);
  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }
  // Returns at once; a message to a lost rank stays on its way for ever.
  void Send(int to, int tag, store::Bytes message);
  // Waits a while for the other ranks and ends the process: without ceremony when one of them is lost.
  [[noreturn]] void End(int status);

 private:
  int rank_ = 0;
  int size_ = 1;
  std::list<std::pair<MPI_Request, store::Bytes>> sent_;
};

// One job at a time per rank, rank 0 included. All calls of one crew come from the thread that started MPI.
class MpiCrew final : public merge::Crew {
 public:
  // progress may be null; rank 0 reports to it.
  MpiCrew(Mpi* mpi, merge::Progress* progress) : mpi_(mpi), progress_(progress) {}
  std::vector<std::vector<merge::Association>> Do(const char* stage, int count,
                                                  const merge::Job<std::vector<merge::Association>>& job) override;
  std::vector<merge::PairOutcome> Do(const char* stage, int count, const merge::Job<merge::PairOutcome>& job) override;
  std::vector<merge::PairRefinement> Do(const char* stage, int count,
                                        const merge::Job<merge::PairRefinement>& job) override;
  std::vector<merge::GroupSolution> Do(const char* stage, int count,
                                       const merge::Job<merge::GroupSolution>& job) override;
  [[nodiscard]] bool Leads() const override { return mpi_->rank() == 0; }

 private:
  using BytesJob = merge::Job<store::Bytes>;

  template <class Result>
  std::vector<Result> DoAll(const char* stage, int count, const merge::Job<Result>& job);
  // Both give the packed results of the stage.
  store::Bytes Lead(const char* stage, int count, const BytesJob& job);
  store::Bytes Follow(const BytesJob& job);

  void ServeRanks(JobBoard* board);

  Mpi* mpi_;
  merge::Progress* progress_;
  std::int32_t stage_ = -1;
};

}  // namespace mapweld::ranks
