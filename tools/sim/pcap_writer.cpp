// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/pcap_writer.hpp"

#include <array>

#include "core/base/byte_io.hpp"

namespace mapweld::sim {
namespace {

constexpr std::size_t kEthernetBytes = 14;
constexpr std::size_t kIpBytes = 20;
constexpr std::size_t kUdpBytes = 8;
constexpr std::size_t kRecordBytes = 16;

constexpr std::array<std::uint8_t, 4> kSensorIp{192, 168, 1, 201};
constexpr std::array<std::uint8_t, 4> kEverybodyIp{255, 255, 255, 255};
constexpr std::array<std::uint8_t, 6> kSensorMac{0x60, 0x76, 0x88, 0x00, 0x00, 0x01};
constexpr std::array<std::uint8_t, 6> kEverybodyMac{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};

std::array<std::uint8_t, kIpBytes> IpHeader(std::size_t udp_payload_bytes, std::uint16_t checksum) {
  std::array<std::uint8_t, kIpBytes> bytes{};
  ByteWriter w(bytes);
  w.Big(std::uint16_t{0x4500});  // version 4, five words
  w.Big(static_cast<std::uint16_t>(kIpBytes + kUdpBytes + udp_payload_bytes));
  w.Big(std::uint32_t{0x00004000});  // not fragmented
  w.Big(std::uint16_t{0x4011});      // 64 hops, UDP
  w.Big(checksum);
  w.Bytes(kSensorIp);
  w.Bytes(kEverybodyIp);
  return bytes;
}

std::uint16_t IpChecksum(std::span<const std::uint8_t> header) {
  std::uint32_t sum = 0;
  ByteReader r(header);
  while (r.remaining() >= 2) sum += r.Big<std::uint16_t>();
  while (sum > 0xFFFF) sum = (sum & 0xFFFF) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum & 0xFFFF);
}

}  // namespace

PcapWriter::PcapWriter(const std::filesystem::path& path, std::uint16_t udp_port) : file_(path), udp_port_(udp_port) {
  std::array<std::uint8_t, 24> header{};
  ByteWriter w(header);
  w.Little(std::uint32_t{0xA1B23C4D});  // nanoseconds
  w.Little(std::uint16_t{2});           // version 2.4
  w.Little(std::uint16_t{4});
  w.Little(std::uint64_t{0});
  w.Little(std::uint32_t{65535});  // longest record
  w.Little(std::uint32_t{1});      // Ethernet
  file_.Write(header);
}

void PcapWriter::Write(std::int64_t stamp_ns, std::span<const std::uint8_t> udp_payload) {
  std::array<std::uint8_t, kRecordBytes + kEthernetBytes + kIpBytes + kUdpBytes> header{};
  ByteWriter w(header);
  const auto frame_bytes = static_cast<std::uint32_t>(header.size() - kRecordBytes + udp_payload.size());
  w.Little(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000));
  w.Little(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
  w.Little(frame_bytes);
  w.Little(frame_bytes);
  w.Bytes(kEverybodyMac);
  w.Bytes(kSensorMac);
  w.Big(std::uint16_t{0x0800});  // IPv4
  w.Bytes(IpHeader(udp_payload.size(), IpChecksum(IpHeader(udp_payload.size(), 0))));
  w.Big(udp_port_);
  w.Big(udp_port_);
  w.Big(static_cast<std::uint16_t>(kUdpBytes + udp_payload.size()));
  w.Big(std::uint16_t{0});  // no checksum, as the sensor does
  file_.Write(header);
  file_.Write(udp_payload);
}

}  // namespace mapweld::sim
