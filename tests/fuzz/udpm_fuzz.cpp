// SPDX-License-Identifier: Apache-2.0
// The input is a stream of datagrams, each after two bytes of length and one of sender.
#include "drivers/bus/udpm_reassembly.hpp"
#include "drivers/bus/udpm_wire.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/drivers/bus/datagrams.hpp"

namespace mapweld::fuzz {
namespace {

void Append(Bytes* stream, const Bytes& datagram) {
  stream->push_back(static_cast<std::uint8_t>(datagram.size() >> 8U));
  stream->push_back(static_cast<std::uint8_t>(datagram.size()));
  stream->push_back(1);
  stream->insert(stream->end(), datagram.begin(), datagram.end());
}

}  // namespace

std::vector<Bytes> Seeds() {
  Bytes good;
  Append(&good, bus::test::Short(7, "MW.1.POSE", bus::test::Pattern(30)));
  Append(&good, bus::test::Fragment({.size = 90, .offset = 0, .number = 0, .count = 3}, bus::test::Pattern(30)));
  Append(&good, bus::test::Fragment({.size = 90, .offset = 60, .number = 2, .count = 3}, bus::test::Pattern(30)));
  Append(&good, bus::test::Fragment({.size = 90, .offset = 30, .number = 1, .count = 3}, bus::test::Pattern(30)));
  Bytes hostile;
  for (const Bytes& datagram : bus::test::HostileDatagrams()) Append(&hostile, datagram);
  return {good, hostile};
}

}  // namespace mapweld::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mapweld;
  fuzz::Input input(data, size);
  static bus::UdpmReassembly reassembly;
  reassembly = {};
  while (!input.empty()) {
    const auto bytes = static_cast<std::size_t>(input.Number(2));
    const bus::Sender sender{.ipv4 = static_cast<std::uint32_t>(input.Number(1)), .port = 1};
    const fuzz::Bytes datagram = input.Take(bytes);
    bus::ParsedDatagram parsed;
    bus::Refusal refusal = bus::ParseDatagram(datagram, &parsed);
    if (refusal != bus::Refusal::kNone) continue;
    FUZZ_REQUIRE(parsed.channel.size() <= bus::kMaxChannelBytes);
    FUZZ_REQUIRE(parsed.payload.size() <= datagram.size());
    if (!parsed.fragment) {
      FUZZ_REQUIRE(!parsed.channel.empty());
      continue;
    }
    bus::BusMessage message;
    const Status status = reassembly.Push(parsed, sender, &message, &refusal);
    FUZZ_REQUIRE((refusal == bus::Refusal::kNone) == (status != Status::kBadInput));
    if (status == Status::kOk) {
      FUZZ_REQUIRE(!message.channel.empty() && message.payload.size() == parsed.message_bytes);
    }
  }
  return 0;
}
