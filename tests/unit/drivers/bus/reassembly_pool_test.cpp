// SPDX-License-Identifier: Apache-2.0
// A million random things happen to the pool of slots: every message that was begun is in a slot, delivered, given up
// or dropped, and nothing is ever two of these or none.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <random>
#include <utility>

#include "drivers/bus/udpm_reassembly.hpp"

namespace mapweld::bus {
namespace {

constexpr std::uint16_t kFragments = 3;
constexpr std::uint32_t kPieceBytes = 16;

class RandomTraffic {
 public:
  // One datagram of one of a few messages under way: the next piece, one again, one that contradicts, or a new message.
  ParsedDatagram Next(Sender* sender) {
    sender->ipv4 = 1 + Number(3);
    std::uint32_t& newest = newest_[sender->ipv4];
    if (Number(6) == 0) ++newest;
    ParsedDatagram datagram;
    datagram.fragment = true;
    datagram.sequence = newest - Number(3);  // or one of the two before it
    datagram.fragments = Number(50) == 0 ? kFragments + 1 : kFragments;
    datagram.message_bytes = kFragments * kPieceBytes;
    datagram.fragment_index = static_cast<std::uint16_t>(Number(kFragments));
    datagram.offset = datagram.fragment_index * kPieceBytes;
    if (datagram.fragment_index == 0) datagram.channel = "CH";
    piece_.fill(static_cast<std::uint8_t>(datagram.sequence));
    if (Number(40) == 0) piece_[3] ^= 1;  // contradicts the same piece
    datagram.payload = std::span(piece_).first(Number(60) == 0 ? kPieceBytes - 1 : kPieceBytes);  // leaves a hole
    return datagram;
  }
  std::uint32_t Number(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }

 private:
  std::mt19937 random_{7};
  std::map<std::uint32_t, std::uint32_t> newest_;
  std::array<std::uint8_t, kPieceBytes> piece_{};
};

TEST(ReassemblyPool, LosesNoSlotInAMillionRandomSteps) {
  const auto pool = std::make_unique<UdpmReassembly>();
  RandomTraffic traffic;
  for (int step = 0; step < 1'000'000; ++step) {
    Sender sender;
    const ParsedDatagram datagram = traffic.Next(&sender);
    BusMessage message;
    Refusal refusal = Refusal::kNone;
    const UdpmReassembly::Counters before = pool->counters();
    const Status status = pool->Push(datagram, sender, &message, &refusal);
    const UdpmReassembly::Counters& now = pool->counters();
    ASSERT_LE(pool->slots_in_use(), UdpmReassembly::kSlots);
    ASSERT_EQ(now.begun, now.completed + now.evicted + now.contradicted + pool->slots_in_use()) << step;
    ASSERT_EQ(now.completed - before.completed, status == Status::kOk ? 1U : 0U);
    ASSERT_EQ(now.contradicted - before.contradicted, status == Status::kBadInput ? 1U : 0U);
    ASSERT_EQ(refusal == Refusal::kNone, status != Status::kBadInput);
  }
  const UdpmReassembly::Counters& end = pool->counters();
  for (const std::uint64_t often : {end.completed, end.evicted, end.contradicted, end.repeated})
    EXPECT_GT(often, 1000U);
}

}  // namespace
}  // namespace mapweld::bus
