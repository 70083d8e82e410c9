// SPDX-License-Identifier: Apache-2.0
#include "tools/ranks/mpi_crew.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "tools/ranks/result_codec.hpp"

namespace mapweld::ranks {
namespace {

using Clock = std::chrono::steady_clock;
using store::Bytes;

// Messages. From a rank: kAsk, with its stage; kAnswer, with its stage, the job and what came of it. From rank 0: kJob,
// with its number; kResults, of the whole stage, to every rank once, asked or not. At the end: kBye from a rank, kEnd
// from rank 0 with whether all are there.
enum Tag : int { kAsk = 1, kAnswer, kJob, kResults, kBye, kEnd };

constexpr std::chrono::microseconds kPoll{300};
constexpr std::chrono::minutes kLeaderLost{30};  // the longest that rank 0 may be silent
constexpr std::chrono::seconds kFarewell{10};

void Append(std::int32_t value, Bytes* to) {
  const std::size_t at = to->size();
  to->resize(at + sizeof(value));
  std::memcpy(to->data() + at, &value, sizeof(value));
}

std::int32_t Number(std::span<const std::uint8_t> bytes) {
  std::int32_t value = -1;
  if (bytes.size() >= sizeof(value)) std::memcpy(&value, bytes.data(), sizeof(value));
  return value;
}

// The next message, if there is one from this rank (or MPI_ANY_SOURCE) with this tag (or MPI_ANY_TAG).
std::optional<Bytes> Poll(int source, int tag, MPI_Status* status) {
  int there = 0;
  if (MPI_Iprobe(source, tag, MPI_COMM_WORLD, &there, status) != MPI_SUCCESS || there == 0) return std::nullopt;
  int size = 0;
  MPI_Get_count(status, MPI_BYTE, &size);
  Bytes message(static_cast<std::size_t>(size));
  const int rc = MPI_Recv(message.data(), size, MPI_BYTE, status->MPI_SOURCE, status->MPI_TAG, MPI_COMM_WORLD, status);
  return rc == MPI_SUCCESS ? std::optional(std::move(message)) : std::nullopt;
}

void SendToLeader(int tag, const Bytes& message) {
  MPI_Send(message.data(), static_cast<int>(message.size()), MPI_BYTE, 0, tag, MPI_COMM_WORLD);
}

Bytes WaitForLeader(int* tag) {
  const auto begin = Clock::now();
  MPI_Status status;
  while (Clock::now() - begin < kLeaderLost) {
    if (auto message = Poll(0, MPI_ANY_TAG, &status)) {
      *tag = status.MPI_TAG;
      return std::move(*message);
    }
    std::this_thread::sleep_for(kPoll);
  }
  throw std::runtime_error("rank 0 has been silent for half an hour; start the merge again");
}

// What a job gives, or why it failed.
Bytes DoJob(int index, const merge::Job<Bytes>& job) {
  Bytes out{1};
  try {
    const Bytes result = job(index);
    out.insert(out.end(), result.begin(), result.end());
  } catch (const std::exception& error) {
    out[0] = 0;
    const std::string why = error.what();
    out.insert(out.end(), why.begin(), why.end());
  }
  return out;
}

}  // namespace

Mpi::Mpi(int* argc, char*** argv) {
  int provided = 0;
  MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

void Mpi::Send(int to, int tag, Bytes message) {
  sent_.remove_if([](auto& sent) {
    int arrived = 0;
    return MPI_Test(&sent.first, &arrived, MPI_STATUS_IGNORE) == MPI_SUCCESS && arrived != 0;
  });
  auto& [request, bytes] = sent_.emplace_back(MPI_REQUEST_NULL, std::move(message));
  MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD, &request);
}

void Mpi::End(int status) {
  std::fflush(nullptr);
  if (status != 0) MPI_Abort(MPI_COMM_WORLD, status);
  std::int32_t all = 1;
  if (rank_ == 0) {
    int here = 1;
    MPI_Status from;
    std::vector<bool> bye(static_cast<std::size_t>(size_), false);
    for (const auto begin = Clock::now(); here < size_ && Clock::now() - begin < kFarewell;) {
      if (!Poll(MPI_ANY_SOURCE, MPI_ANY_TAG, &from)) {
        std::this_thread::sleep_for(kPoll);
      } else if (from.MPI_TAG == kBye) {
        bye[static_cast<std::size_t>(from.MPI_SOURCE)] = true;
        ++here;
      }
    }
    all = here == size_ ? 1 : 0;
    for (int rank = 1; rank < size_; ++rank) {
      if (bye[static_cast<std::size_t>(rank)]) MPI_Send(&all, sizeof(all), MPI_BYTE, rank, kEnd, MPI_COMM_WORLD);
    }
  } else {
    SendToLeader(kBye, {});
    int tag = 0;
    Bytes end;
    do {
      end = WaitForLeader(&tag);
    } while (tag != kEnd);
    all = Number(end);
  }
  if (all == 1) MPI_Finalize();
  ::_exit(0);
}

template <class Result>
std::vector<Result> MpiCrew::DoAll(const char* stage, int count, const merge::Job<Result>& job) {
  ++stage_;
  const BytesJob encoded = [&](int i) { return Encode(job(i)); };
  const Bytes all = mpi_->rank() == 0 ? Lead(stage, count, encoded) : Follow(encoded);
  std::vector<Result> results;
  for (const Bytes& answer : Unpack(all)) {
    const std::span<const std::uint8_t> body = std::span(answer).subspan(1);
    if (answer.front() == 0) throw std::runtime_error(std::string(body.begin(), body.end()));
    Decode(body, &results.emplace_back());
  }
  return results;
}

Bytes MpiCrew::Lead(const char* stage, int count, const BytesJob& job) {
  JobBoard board(count);
  std::mutex mutex;  // of the board
  std::jthread own([&] {
    for (;;) {
      std::optional<int> next;
      {
        const std::lock_guard lock(mutex);
        next = board.Take();
      }
      if (!next.has_value()) return;
      Bytes result = DoJob(*next, job);
      const std::lock_guard lock(mutex);
      (void)board.Put(*next, std::move(result));
    }
  });
  int told = 0;
  for (;;) {
    {
      const std::lock_guard lock(mutex);
      ServeRanks(&board);
      if (progress_ != nullptr && board.done() > told) progress_->Report(stage, told = board.done(), count);
      if (board.AllDone()) break;
    }
    std::this_thread::sleep_for(kPoll);
  }
  own.join();
  Bytes results = Pack(std::move(board).Results());
  for (int rank = 1; rank < mpi_->size(); ++rank) mpi_->Send(rank, kResults, results);
  return results;
}

// Asks and answers of a stage that is over need nothing more: its results are on their way.
void MpiCrew::ServeRanks(JobBoard* board) {
  MPI_Status status;
  while (auto message = Poll(MPI_ANY_SOURCE, MPI_ANY_TAG, &status)) {
    if (Number(*message) != stage_) continue;
    if (status.MPI_TAG == kAnswer) {
      const std::int32_t job = Number(std::span(*message).subspan(sizeof(std::int32_t)));
      (void)board->Put(job, {message->begin() + 2 * sizeof(std::int32_t), message->end()});
    } else if (const std::optional<int> job = board->Take()) {
      Bytes number;
      Append(*job, &number);
      mpi_->Send(status.MPI_SOURCE, kJob, std::move(number));
    }
  }
}

Bytes MpiCrew::Follow(const BytesJob& job) {
  for (;;) {
    Bytes ask;
    Append(stage_, &ask);
    SendToLeader(kAsk, ask);
    int tag = 0;
    Bytes message = WaitForLeader(&tag);
    if (tag == kResults) return message;
    const std::int32_t index = Number(message);
    Bytes answer;
    Append(stage_, &answer);
    Append(index, &answer);
    const Bytes result = DoJob(index, job);
    answer.insert(answer.end(), result.begin(), result.end());
    SendToLeader(kAnswer, answer);
  }
}

std::vector<std::vector<merge::Association>> MpiCrew::Do(const char* stage, int count,
                                                         const merge::Job<std::vector<merge::Association>>& job) {
  return DoAll(stage, count, job);
}
std::vector<merge::PairOutcome> MpiCrew::Do(const char* stage, int count, const merge::Job<merge::PairOutcome>& job) {
  return DoAll(stage, count, job);
}
std::vector<merge::PairRefinement> MpiCrew::Do(const char* stage, int count,
                                               const merge::Job<merge::PairRefinement>& job) {
  return DoAll(stage, count, job);
}
std::vector<merge::GroupSolution> MpiCrew::Do(const char* stage, int count,
                                              const merge::Job<merge::GroupSolution>& job) {
  return DoAll(stage, count, job);
}

}  // namespace mapweld::ranks
