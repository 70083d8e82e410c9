// SPDX-License-Identifier: Apache-2.0
// Puts fragmented LCM messages together in a fixed pool of slots. Fragments may come in any order; an exact repetition
// is ignored; a message is handed out only when its pieces cover it exactly once. A fragment that contradicts earlier
// ones drops its whole message. When all slots are taken, the message that was begun first gives way. Owns 4 x 16 KiB
// and little more. Cost per fragment: its copy, and one pass over at most 64 pieces at the end.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/status.hpp"
#include "drivers/bus/udpm_wire.hpp"

namespace mapweld::bus {

struct BusMessage {
  std::string_view channel;
  std::span<const std::uint8_t> payload;
};

struct Sender {
  std::uint32_t ipv4 = 0;
  std::uint16_t port = 0;
  bool operator==(const Sender&) const = default;
};

class UdpmReassembly {
 public:
  static constexpr std::size_t kSlots = 4;
  static constexpr std::size_t kSlotBytes = 16384;
  static constexpr std::size_t kMaxFragments = 64;

  struct Counters {
    std::uint64_t begun = 0;  // messages; each is in a slot, or one of the next three
    std::uint64_t completed = 0;
    std::uint64_t evicted = 0;       // gave way to a newer one
    std::uint64_t contradicted = 0;  // dropped because of a fragment that did not fit
    std::uint64_t repeated = 0;      // fragments ignored
  };

  // `datagram` must be a fragment accepted by ParseDatagram. kOk: *message is complete and valid until the next call;
  // kNotReady: more fragments are needed; kBadInput: refused for *refusal, which is kTooLarge or kContradicts.
  Status Push(const ParsedDatagram& datagram, const Sender& sender, BusMessage* message, Refusal* refusal);

  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] std::size_t slots_in_use() const {
    return static_cast<std::size_t>(std::ranges::count(slots_, true, &Slot::used));
  }

 private:
  struct Piece {
    std::uint16_t offset = 0;
    std::uint16_t bytes = 0;
  };
  struct Slot {
    bool used = false;
    Sender sender;
    std::uint32_t sequence = 0;
    std::uint64_t begun = 0;  // order of first fragments
    std::uint32_t message_bytes = 0;
    std::uint16_t fragments = 0;
    std::uint64_t present = 0;  // bit per fragment
    std::array<Piece, kMaxFragments> pieces{};
    std::size_t channel_bytes = 0;
    std::array<char, kMaxChannelBytes> channel{};
    std::array<std::uint8_t, kSlotBytes> data{};
  };
  static_assert(kMaxFragments <= 64);

  Slot& FindOrBegin(const ParsedDatagram& datagram, const Sender& sender);
  static bool SameAsBefore(const Slot& slot, const ParsedDatagram& datagram);
  static bool CoversExactly(const Slot& slot);

  Status Drop(Slot* slot);

  std::array<Slot, kSlots> slots_{};
  Counters counters_;
};

}  // namespace mapweld::bus
