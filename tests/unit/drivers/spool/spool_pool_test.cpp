// SPDX-License-Identifier: Apache-2.0
// A million random things happen to a small spool: every record that was appended is there or was given up, oldest
// first, and reads back as it was.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <deque>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "drivers/spool/record_spool.hpp"

namespace mapweld::spool {
namespace {

constexpr std::uint64_t kFileBytes = 16 << 10;
using Bytes = std::vector<std::uint8_t>;

// What should be in there, from the oldest to the newest.
struct Stored {
  RecordSpool::Key key;
  Bytes content;
};

class RandomSpool {
 public:
  RandomSpool() { EXPECT_EQ(spool_->Open(path_.c_str(), kFileBytes), Status::kOk); }
  ~RandomSpool() { ::close(fd_); }

  void Append() {
    const Stored record{{epoch_, static_cast<std::uint8_t>(random_() % 2), next_++},
                        Bytes(1 + random_() % 300, Byte())};
    ASSERT_EQ(spool_->Append(record.key, record.content), Status::kOk);
    model_.push_back(record);
    Forget();
  }
  void Read() {
    if (model_.empty()) return;
    const Stored& record = model_[random_() % model_.size()];
    Bytes out(300);
    const auto got = spool_->Read(record.key, out);
    ASSERT_TRUE(got.ok());
    out.resize(got.value());
    ASSERT_EQ(out, record.content);
  }
  void Reboot() {
    spool_->Close();
    const std::uint64_t recovered = spool_->counters().recovered;
    ASSERT_EQ(spool_->Open(path_.c_str(), kFileBytes), Status::kOk);
    ASSERT_EQ(spool_->counters().recovered - recovered, model_.size());
    ++epoch_;
  }
  void RequireConserved() {
    ASSERT_EQ(spool_->size(), model_.size());
    ASSERT_EQ(spool_->counters().appended, spool_->size() + spool_->counters().given_up);
  }
  std::uint32_t Number(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }
  [[nodiscard]] const RecordSpool& spool() const { return *spool_; }

 private:
  std::uint8_t Byte() { return static_cast<std::uint8_t>(random_()); }
  // The spool gives up its oldest ones only.
  void Forget() {
    for (; forgotten_ < spool_->counters().given_up; ++forgotten_) {
      ASSERT_FALSE(model_.empty());
      ASSERT_FALSE(spool_->Has(model_.front().key));
      model_.pop_front();
    }
  }

  std::mt19937 random_{9};
  int fd_ = ::memfd_create("spool", 0);  // no disk, so that a million steps take seconds
  std::string path_ = "/proc/self/fd/" + std::to_string(fd_);
  std::unique_ptr<RecordSpool> spool_ = std::make_unique<RecordSpool>();
  std::deque<Stored> model_;
  std::uint64_t forgotten_ = 0;
  std::int32_t epoch_ = 1;
  std::int32_t next_ = 0;
};

TEST(RecordSpoolPool, LosesNothingInAMillionRandomSteps) {
  RandomSpool spool;
  for (int step = 0; step < 1'000'000; ++step) {
    const std::uint32_t what = spool.Number(1000);
    if (what == 0) {
      ASSERT_NO_FATAL_FAILURE(spool.Reboot());
    } else if (what < 300) {
      ASSERT_NO_FATAL_FAILURE(spool.Append());
    } else {
      ASSERT_NO_FATAL_FAILURE(spool.Read());
    }
    ASSERT_NO_FATAL_FAILURE(spool.RequireConserved()) << step;
  }
  EXPECT_GT(spool.spool().counters().given_up, 250'000U);
}

}  // namespace
}  // namespace mapweld::spool
