// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/answer_queue.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/support/temporary_directory.hpp"

namespace mapweld::executive {
namespace {

constexpr TimeNs kStart{1'000'000'000};

// The bus is closed: publishing fails quietly, and what would leave is seen by the counters.
class AnswerQueueTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(spool_->Open(directory_.File("spool").c_str(), 4 << 20), Status::kOk);
    for (int i = 0; i < 10; ++i) {
      const std::vector<std::uint8_t> submap(50'000, static_cast<std::uint8_t>(i));
      ASSERT_EQ(spool_->Append({1, static_cast<std::uint8_t>(RecordKind::kSubmap), i}, submap), Status::kOk);
    }
  }
  static mapweldlcm::request_t Request(std::vector<int> keyframes) {
    mapweldlcm::request_t request{};
    request.agent_id = 1;
    request.epoch = 1;
    request.kind = mapweldlcm::request_t::KIND_SUBMAP;
    request.n = static_cast<std::int16_t>(keyframes.size());
    std::copy(keyframes.begin(), keyframes.end(), request.index);
    return request;
  }

  test::TemporaryDirectory directory_;
  std::unique_ptr<spool::RecordSpool> spool_ = std::make_unique<spool::RecordSpool>();
  std::unique_ptr<bus::UdpmBus> bus_ = std::make_unique<bus::UdpmBus>();
  std::unique_ptr<Telemetry> telemetry_ = std::make_unique<Telemetry>(Identity{1, 1}, bus_.get());
  std::unique_ptr<AnswerQueue> answers_ = std::make_unique<AnswerQueue>(100'000, spool_.get(), telemetry_.get());
};

TEST_F(AnswerQueueTest, SendsEverythingThatWasAskedForAndIsThere) {
  answers_->Add(Request({3, 4, 77}));
  TimeNs now = kStart;
  int steps = 0;
  while (answers_->Step(now) && ++steps < 10'000) now = now + Milliseconds(1);
  EXPECT_EQ(answers_->submaps_sent(), 2);
}

TEST_F(AnswerQueueTest, NeverLeavesFasterThanTheBudget) {
  answers_->Add(Request({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  TimeNs now = kStart;
  while (answers_->Step(now)) now = now + Milliseconds(1);
  // 500 kB in chunks of 1280, each counted as a full datagram, at 100 kB/s, less the burst.
  const double least_s = (10 * 40 * 1400 - 32 * 1400) / 100'000.0;
  EXPECT_GE((now - kStart).Seconds(), least_s - 0.01);
  EXPECT_LE((now - kStart).Seconds(), least_s + 0.5);
}

TEST_F(AnswerQueueTest, AskingTwiceSendsOnce) {
  answers_->Add(Request({5}));
  answers_->Add(Request({5, 5}));
  TimeNs now = kStart;
  while (answers_->Step(now)) now = now + Milliseconds(1);
  EXPECT_EQ(answers_->submaps_sent(), 1);
}

TEST_F(AnswerQueueTest, AnswersForEarlierBootsAndNotForOthers) {
  const std::vector<std::uint8_t> submap(3000, 7);
  ASSERT_EQ(spool_->Append({7, static_cast<std::uint8_t>(RecordKind::kSubmap), 5}, submap), Status::kOk);
  auto request = Request({5});
  for (const int epoch : {7, 8}) {
    request.epoch = epoch;
    answers_->Add(request);
  }
  TimeNs now = kStart;
  while (answers_->Step(now)) now = now + Milliseconds(1);
  EXPECT_EQ(answers_->submaps_sent(), 1);
}

}  // namespace
}  // namespace mapweld::executive
