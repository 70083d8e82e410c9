// SPDX-License-Identifier: Apache-2.0
#include "drivers/bus/udpm_wire.hpp"

#include <algorithm>
#include <cstring>

#include "core/base/byte_io.hpp"

namespace mapweld::bus {
namespace {

// Takes the channel and its NUL off the front of `rest`.
bool TakeChannel(std::span<const std::uint8_t>* rest, std::string_view* channel) {
  const std::size_t window = std::min(rest->size(), kMaxChannelBytes + 1);
  const auto end = std::find(rest->begin(), rest->begin() + static_cast<std::ptrdiff_t>(window), std::uint8_t{0});
  const auto length = static_cast<std::size_t>(end - rest->begin());
  if (length == window || length == 0) return false;
  *channel = {reinterpret_cast<const char*>(rest->data()), length};
  *rest = rest->subspan(length + 1);
  return true;
}

Refusal ParseFragment(std::span<const std::uint8_t> datagram, ParsedDatagram* out) {
  if (datagram.size() < kFragmentHeaderBytes) return Refusal::kTooShort;
  ByteReader reader(datagram);
  reader.Skip(4);
  out->fragment = true;
  out->sequence = reader.Big<std::uint32_t>();
  out->message_bytes = reader.Big<std::uint32_t>();
  out->offset = reader.Big<std::uint32_t>();
  out->fragment_index = reader.Big<std::uint16_t>();
  out->fragments = reader.Big<std::uint16_t>();
  if (out->fragment_index >= out->fragments) return Refusal::kFragment;
  out->payload = datagram.subspan(kFragmentHeaderBytes);
  if (out->fragment_index == 0 && !TakeChannel(&out->payload, &out->channel)) return Refusal::kChannel;
  // In 64 bits, so that a large offset cannot wrap around.
  const std::uint64_t end = std::uint64_t{out->offset} + out->payload.size();
  if (out->payload.empty() || end > out->message_bytes) return Refusal::kFragment;
  if ((out->fragment_index == 0) != (out->offset == 0)) return Refusal::kFragment;
  return Refusal::kNone;
}

}  // namespace

Refusal ParseDatagram(std::span<const std::uint8_t> datagram, ParsedDatagram* out) {
  *out = {};
  if (datagram.size() < kShortHeaderBytes) return Refusal::kTooShort;
  ByteReader reader(datagram);
  const std::uint32_t magic = reader.Big<std::uint32_t>();
  if (magic == kFragmentMagic) return ParseFragment(datagram, out);
  if (magic != kShortMagic) return Refusal::kMagic;
  out->sequence = reader.Big<std::uint32_t>();
  out->payload = datagram.subspan(kShortHeaderBytes);
  return TakeChannel(&out->payload, &out->channel) ? Refusal::kNone : Refusal::kChannel;
}

Result<std::size_t> EncodeShortHeader(std::uint32_t sequence, std::string_view channel, std::span<std::uint8_t> out) {
  if (channel.empty() || channel.size() > kMaxChannelBytes || channel.find('\0') != std::string_view::npos) {
    return Status::kOutOfRange;
  }
  const std::size_t bytes = kShortHeaderBytes + channel.size() + 1;
  if (out.size() < bytes) return Status::kFull;
  ByteWriter writer(out);
  writer.Big(kShortMagic);
  writer.Big(sequence);
  writer.Bytes({reinterpret_cast<const std::uint8_t*>(channel.data()), channel.size()});
  writer.Little(std::uint8_t{0});
  return bytes;
}

}  // namespace mapweld::bus
