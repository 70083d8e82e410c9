// SPDX-License-Identifier: Apache-2.0
// LCM's UDP multicast datagrams, encoded and parsed. Pure, no sockets. All integers are big-endian.
//   short     "LC02" u32 sequence | channel NUL | payload
//   fragment  "LC03" u32 sequence, u32 payload size, u32 offset, u16 fragment, u16 fragments | [fragment 0: channel
//   NUL] |
//             a piece of the payload
// Source: LCM's protocol page (udp-multicast-protocol).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/status.hpp"

namespace mapweld::bus {

inline constexpr std::uint32_t kShortMagic = 0x4C433032;
inline constexpr std::uint32_t kFragmentMagic = 0x4C433033;
inline constexpr std::size_t kShortHeaderBytes = 8;
inline constexpr std::size_t kFragmentHeaderBytes = 20;
inline constexpr std::size_t kMaxChannelBytes = 63;      // without the NUL
inline constexpr std::size_t kMaxDatagramBytes = 65507;  // UDP over IPv4

enum class Refusal : std::uint8_t {
  kNone,
  kTooShort,     // shorter than its header
  kMagic,        // not LCM
  kChannel,      // empty, longer than LCM allows, or no NUL within the datagram
  kTooLarge,     // claims a message larger than a reassembly slot, or more fragments than it has room for
  kFragment,     // number, offset and size do not fit together
  kContradicts,  // differs from earlier fragments of the same message
};

struct ParsedDatagram {
  bool fragment = false;
  std::uint32_t sequence = 0;
  std::string_view channel;               // empty in fragments after the first
  std::span<const std::uint8_t> payload;  // the whole of it, or this fragment's piece
  std::uint32_t message_bytes = 0;        // of a fragment: size of the whole payload
  std::uint32_t offset = 0;
  std::uint16_t fragment_index = 0;
  std::uint16_t fragments = 0;
};

// Views into `datagram`. A parsed fragment is consistent in itself: its piece is not empty and lies inside the message.
Refusal ParseDatagram(std::span<const std::uint8_t> datagram, ParsedDatagram* out);

// Writes header, channel and NUL of a short message; the payload follows on the wire. kOutOfRange for a channel that is
// empty, too long or holds a NUL; kFull when `out` is too small.
Result<std::size_t> EncodeShortHeader(std::uint32_t sequence, std::string_view channel, std::span<std::uint8_t> out);

}  // namespace mapweld::bus
