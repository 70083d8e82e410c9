// SPDX-License-Identifier: Apache-2.0
#include "drivers/bus/udpm_reassembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "tests/unit/drivers/bus/datagrams.hpp"

namespace mapweld::bus {
namespace {

using test::Bytes;

class UdpmReassemblyTest : public testing::Test {
 protected:
  Status Push(const Bytes& datagram, Sender sender = {.ipv4 = 1, .port = 2}) {
    ParsedDatagram parsed;
    refusal_ = ParseDatagram(datagram, &parsed);
    if (refusal_ != Refusal::kNone) return Status::kBadInput;
    return reassembly_->Push(parsed, sender, &message_, &refusal_);
  }
  // `payload` cut into pieces of `step` bytes.
  static std::vector<Bytes> Cut(const Bytes& payload, std::size_t step, std::uint32_t sequence) {
    std::vector<Bytes> out;
    const auto count = static_cast<unsigned>((payload.size() + step - 1) / step);
    for (unsigned i = 0; i < count; ++i) {
      const std::size_t at = i * step;
      out.push_back(test::Fragment({.sequence = sequence,
                                    .size = static_cast<std::uint32_t>(payload.size()),
                                    .offset = static_cast<std::uint32_t>(at),
                                    .number = i,
                                    .count = count},
                                   std::span(payload).subspan(at, std::min(step, payload.size() - at))));
    }
    return out;
  }
  bool Delivered(const Bytes& payload) const {
    return message_.channel == "CH" &&
           std::equal(payload.begin(), payload.end(), message_.payload.begin(), message_.payload.end());
  }

  std::unique_ptr<UdpmReassembly> reassembly_ = std::make_unique<UdpmReassembly>();
  BusMessage message_;
  Refusal refusal_ = Refusal::kNone;
};

TEST_F(UdpmReassemblyTest, DeliversWhenTheLastPieceArrivesInAnyOrder) {
  std::mt19937 random(3);
  for (std::uint32_t sequence = 0; sequence < 200; ++sequence) {
    const Bytes payload = test::Pattern(1 + random() % UdpmReassembly::kSlotBytes, sequence);
    std::vector<Bytes> pieces = Cut(payload, 300 + random() % 2000, sequence);
    std::shuffle(pieces.begin(), pieces.end(), random);
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) ASSERT_EQ(Push(pieces[i]), Status::kNotReady);
    ASSERT_EQ(Push(pieces.back()), Status::kOk);
    ASSERT_TRUE(Delivered(payload));
  }
  EXPECT_EQ(reassembly_->counters().evicted, 0U);
}

TEST_F(UdpmReassemblyTest, IgnoresExactRepetitions) {
  const Bytes payload = test::Pattern(3000);
  const std::vector<Bytes> pieces = Cut(payload, 1000, 1);
  EXPECT_EQ(Push(pieces[0]), Status::kNotReady);
  EXPECT_EQ(Push(pieces[1]), Status::kNotReady);
  EXPECT_EQ(Push(pieces[1]), Status::kNotReady) << "two copies of one piece are not two pieces";
  EXPECT_EQ(Push(pieces[0]), Status::kNotReady);
  EXPECT_EQ(Push(pieces[2]), Status::kOk);
  EXPECT_TRUE(Delivered(payload));
  EXPECT_EQ(reassembly_->counters().repeated, 2U);
}

TEST_F(UdpmReassemblyTest, DropsAMessageThatContradictsItself) {
  const Bytes payload = test::Pattern(3000);
  const std::vector<Bytes> pieces = Cut(payload, 1000, 1);
  const auto expect_dropped = [&](const Bytes& bad) {
    ASSERT_EQ(Push(pieces[0]), Status::kNotReady);
    ASSERT_EQ(Push(pieces[1]), Status::kNotReady);
    ASSERT_EQ(Push(bad), Status::kBadInput);
    ASSERT_EQ(refusal_, Refusal::kContradicts);
    // What is left of it alone does not make a message.
    ASSERT_EQ(Push(pieces[2]), Status::kNotReady);
    ASSERT_EQ(Push(pieces[0]), Status::kNotReady);
    ASSERT_EQ(Push(pieces[1]), Status::kOk);
    ASSERT_TRUE(Delivered(payload));
  };
  expect_dropped(test::Fragment({.size = 3001, .offset = 2000, .number = 2, .count = 3}, test::Pattern(1000)));
  expect_dropped(test::Fragment({.size = 3000, .offset = 2000, .number = 2, .count = 4}, test::Pattern(1000)));
  expect_dropped(test::Fragment({.size = 3000, .offset = 1000, .number = 1, .count = 3}, test::Pattern(1000, 99)));
  expect_dropped(test::Fragment({.size = 3000, .offset = 1001, .number = 1, .count = 3}, test::Pattern(1000)));
}

TEST_F(UdpmReassemblyTest, DropsPiecesThatOverlapOrLeaveHoles) {
  const auto assemble = [&](std::uint32_t second_offset, std::size_t second_bytes, std::uint32_t size) {
    EXPECT_EQ(Push(test::Fragment({.size = size, .number = 0, .count = 2}, test::Pattern(1000))), Status::kNotReady);
    return Push(
        test::Fragment({.size = size, .offset = second_offset, .number = 1, .count = 2}, test::Pattern(second_bytes)));
  };
  EXPECT_EQ(assemble(1000, 1000, 2000), Status::kOk);
  EXPECT_EQ(assemble(900, 1100, 2000), Status::kBadInput) << "overlap";
  EXPECT_EQ(assemble(1100, 900, 2000), Status::kBadInput) << "hole";
  EXPECT_EQ(assemble(1000, 900, 2000), Status::kBadInput) << "end missing";
  EXPECT_EQ(assemble(500, 1000, 2000), Status::kBadInput) << "overlap and end missing";
}

TEST_F(UdpmReassemblyTest, RefusesWhatIsTooLargeBeforeReservingAnything) {
  EXPECT_EQ(Push(test::Fragment({.size = UdpmReassembly::kSlotBytes + 1, .count = 2}, test::Pattern(10))),
            Status::kBadInput);
  EXPECT_EQ(refusal_, Refusal::kTooLarge);
  EXPECT_EQ(Push(test::Fragment({.size = 1000, .count = UdpmReassembly::kMaxFragments + 1}, test::Pattern(10))),
            Status::kBadInput);
  EXPECT_EQ(refusal_, Refusal::kTooLarge);
}

TEST_F(UdpmReassemblyTest, GivesUpTheOldestMessageFirst) {
  const Bytes payload = test::Pattern(2000);
  for (std::uint32_t sequence = 0; sequence <= UdpmReassembly::kSlots; ++sequence) {
    ASSERT_EQ(Push(Cut(payload, 1000, sequence)[0]), Status::kNotReady);
  }
  EXPECT_EQ(reassembly_->counters().evicted, 1U);
  for (std::uint32_t sequence = 1; sequence <= UdpmReassembly::kSlots; ++sequence) {
    ASSERT_EQ(Push(Cut(payload, 1000, sequence)[1]), Status::kOk) << sequence;
  }
  EXPECT_EQ(Push(Cut(payload, 1000, 0)[1]), Status::kNotReady) << "its first piece is gone";
}

TEST_F(UdpmReassemblyTest, KeepsSendersApart) {
  const std::vector<Bytes> a = Cut(test::Pattern(2000, 1), 1000, 5);
  const std::vector<Bytes> b = Cut(test::Pattern(2000, 2), 1000, 5);
  ASSERT_EQ(Push(a[0], {.ipv4 = 1, .port = 1}), Status::kNotReady);
  ASSERT_EQ(Push(b[0], {.ipv4 = 1, .port = 2}), Status::kNotReady);
  ASSERT_EQ(Push(b[1], {.ipv4 = 1, .port = 2}), Status::kOk);
  EXPECT_TRUE(Delivered(test::Pattern(2000, 2)));
  ASSERT_EQ(Push(a[1], {.ipv4 = 1, .port = 1}), Status::kOk);
  EXPECT_TRUE(Delivered(test::Pattern(2000, 1)));
}

TEST_F(UdpmReassemblyTest, DeliversNothingButWholeMessagesUnderLossAndRepetition) {
  std::mt19937 random(11);
  int delivered = 0;
  for (std::uint32_t sequence = 0; sequence < 20'000; ++sequence) {
    const Bytes payload = test::Pattern(2000 + random() % 4000, sequence);
    std::vector<Bytes> pieces = Cut(payload, 1000, sequence);
    if (random() % 3 == 0) pieces.push_back(pieces[random() % pieces.size()]);
    if (random() % 3 == 0) pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(random() % pieces.size()));
    std::shuffle(pieces.begin(), pieces.end(), random);
    for (const Bytes& piece : pieces) {
      if (Push(piece) != Status::kOk) continue;
      ++delivered;
      ASSERT_TRUE(Delivered(payload));
    }
  }
  EXPECT_GT(delivered, 13'000);
}

}  // namespace
}  // namespace mapweld::bus
