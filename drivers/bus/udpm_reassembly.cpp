// SPDX-License-Identifier: Apache-2.0
#include "drivers/bus/udpm_reassembly.hpp"

#include <algorithm>
#include <cstring>

namespace mapweld::bus {

UdpmReassembly::Slot& UdpmReassembly::FindOrBegin(const ParsedDatagram& datagram, const Sender& sender) {
  Slot* oldest = &slots_[0];
  for (Slot& slot : slots_) {
    if (slot.used && slot.sender == sender && slot.sequence == datagram.sequence) return slot;
    if (!slot.used) {
      oldest = &slot;
    } else if (oldest->used && slot.begun < oldest->begun) {
      oldest = &slot;
    }
  }
  if (oldest->used) ++counters_.evicted;
  oldest->used = true;
  oldest->sender = sender;
  oldest->sequence = datagram.sequence;
  oldest->begun = counters_.begun++;
  oldest->message_bytes = datagram.message_bytes;
  oldest->fragments = datagram.fragments;
  oldest->present = 0;
  oldest->channel_bytes = 0;
  return *oldest;
}

Status UdpmReassembly::Drop(Slot* slot) {
  slot->used = false;
  ++counters_.contradicted;
  return Status::kBadInput;
}

bool UdpmReassembly::SameAsBefore(const Slot& slot, const ParsedDatagram& datagram) {
  const Piece& piece = slot.pieces[datagram.fragment_index];
  return piece.offset == datagram.offset && piece.bytes == datagram.payload.size() &&
         std::equal(datagram.payload.begin(), datagram.payload.end(), slot.data.begin() + piece.offset) &&
         (datagram.fragment_index != 0 ||
          std::string_view(slot.channel.data(), slot.channel_bytes) == datagram.channel);
}

// Every piece begins where the one before it ends, from 0 to the size of the message.
bool UdpmReassembly::CoversExactly(const Slot& slot) {
  std::uint32_t end = 0;
  for (std::size_t i = 0; i < slot.fragments; ++i) {
    if (slot.pieces[i].offset != end) return false;
    end += slot.pieces[i].bytes;
  }
  return end == slot.message_bytes;
}

Status UdpmReassembly::Push(const ParsedDatagram& datagram, const Sender& sender, BusMessage* message,
                            Refusal* refusal) {
  *refusal = Refusal::kTooLarge;
  if (datagram.message_bytes > kSlotBytes || datagram.fragments > kMaxFragments) return Status::kBadInput;
  Slot& slot = FindOrBegin(datagram, sender);
  *refusal = Refusal::kContradicts;
  if (slot.message_bytes != datagram.message_bytes || slot.fragments != datagram.fragments) return Drop(&slot);
  const std::uint64_t bit = std::uint64_t{1} << datagram.fragment_index;
  if ((slot.present & bit) != 0) {
    if (SameAsBefore(slot, datagram)) {
      ++counters_.repeated;
      *refusal = Refusal::kNone;
      return Status::kNotReady;
    }
    return Drop(&slot);
  }
  slot.present |= bit;
  slot.pieces[datagram.fragment_index] = {.offset = static_cast<std::uint16_t>(datagram.offset),
                                          .bytes = static_cast<std::uint16_t>(datagram.payload.size())};
  std::memcpy(slot.data.data() + datagram.offset, datagram.payload.data(), datagram.payload.size());
  if (datagram.fragment_index == 0) {
    slot.channel_bytes = datagram.channel.size();
    std::memcpy(slot.channel.data(), datagram.channel.data(), datagram.channel.size());
  }
  const std::uint64_t all = ~std::uint64_t{0} >> (64U - slot.fragments);
  *refusal = Refusal::kNone;
  if (slot.present != all) return Status::kNotReady;
  if (!CoversExactly(slot)) {
    *refusal = Refusal::kContradicts;
    return Drop(&slot);
  }
  slot.used = false;
  ++counters_.completed;
  message->channel = {slot.channel.data(), slot.channel_bytes};
  message->payload = std::span<const std::uint8_t>(slot.data).first(slot.message_bytes);
  return Status::kOk;
}

}  // namespace mapweld::bus
