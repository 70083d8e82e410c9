// SPDX-License-Identifier: Apache-2.0
#include "tools/replay/lidar_capture.hpp"

#include <fmt/format.h>
#include <pcap/pcap.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/byte_io.hpp"

namespace mapweld::replay {
namespace {

constexpr std::uint16_t kIpv4 = 0x0800;
constexpr std::uint16_t kVlanTag = 0x8100;

// Takes the headers before IPv4 off; false when something else follows.
bool TakeLinkHeader(ByteReader& r, int link_type) {
  if (link_type == DLT_RAW) return true;
  r.Skip(link_type == DLT_LINUX_SLL ? 14 : 12);  // addresses
  auto type = r.Big<std::uint16_t>();
  while (type == kVlanTag && !r.failed()) {
    r.Skip(2);
    type = r.Big<std::uint16_t>();
  }
  return type == kIpv4;
}

}  // namespace

std::span<const std::uint8_t> UdpPayload(std::span<const std::uint8_t> frame, int link_type,
                                         std::span<const std::uint16_t> ports) {
  constexpr std::uint8_t kUdp = 17;
  constexpr std::uint16_t kFragmentBits = 0x3FFF;
  ByteReader r(frame);
  if (!TakeLinkHeader(r, link_type)) return {};
  const auto version_words = r.Big<std::uint8_t>();
  r.Skip(5);
  const auto fragment = r.Big<std::uint16_t>();
  r.Skip(1);
  const auto protocol = r.Big<std::uint8_t>();
  const std::size_t header_bytes = (version_words & 0x0FU) * 4U;
  if ((version_words >> 4U) != 4 || header_bytes < 20 || protocol != kUdp || (fragment & kFragmentBits) != 0) return {};
  r.Skip(header_bytes - 10);  // of which ten bytes are read
  r.Skip(2);                  // source port
  const auto to_port = r.Big<std::uint16_t>();
  const auto udp_bytes = r.Big<std::uint16_t>();
  r.Skip(2);  // checksum
  if (std::find(ports.begin(), ports.end(), to_port) == ports.end() || udp_bytes < 8) return {};
  return r.Bytes(udp_bytes - 8U);
}

void LidarCapture::Closer::operator()(pcap* file) const {
  pcap_close(file);
}

LidarCapture::LidarCapture(const std::filesystem::path& file) {
  std::array<char, PCAP_ERRBUF_SIZE> message{};
  file_.reset(pcap_open_offline_with_tstamp_precision(file.c_str(), PCAP_TSTAMP_PRECISION_NANO, message.data()));
  if (file_ == nullptr) {
    throw std::runtime_error(fmt::format("cannot read capture {}: {}", file.string(), message.data()));
  }
  link_type_ = pcap_datalink(file_.get());
  if (link_type_ != DLT_EN10MB && link_type_ != DLT_LINUX_SLL && link_type_ != DLT_RAW) {
    throw std::runtime_error(fmt::format("capture {} is of link type {}; record the LiDAR's Ethernet interface instead",
                                         file.string(), link_type_));
  }
}

bool LidarCapture::Next(Datagram* datagram) {
  pcap_pkthdr* header = nullptr;
  const u_char* bytes = nullptr;
  for (;;) {
    const int outcome = pcap_next_ex(file_.get(), &header, &bytes);
    if (outcome != 1) {
      truncated_ = outcome == PCAP_ERROR;
      return false;
    }
    const auto payload = UdpPayload({bytes, header->caplen}, link_type_, kLidarPorts);
    if (payload.empty()) continue;
    // With this precision the field called microseconds holds nanoseconds.
    *datagram = {std::int64_t{header->ts.tv_sec} * 1'000'000'000 + header->ts.tv_usec, payload};
    return true;
  }
}

}  // namespace mapweld::replay
