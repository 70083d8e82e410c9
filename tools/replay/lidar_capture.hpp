// SPDX-License-Identifier: Apache-2.0
// Reads the LiDAR's datagrams out of a capture file (pcap or pcapng) of anything.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

struct pcap;

namespace mapweld::replay {

// Where LiDARs send their data packets unless told otherwise: Velodyne and Hesai, Ouster.
inline constexpr std::array<std::uint16_t, 2> kLidarPorts{2368, 7502};

// The payload of an unfragmented IPv4 UDP datagram to one of the ports; empty for everything else. `link_type` is
// pcap's number of the outermost header: Ethernet with or without VLAN tags, Linux cooked, or bare IP.
std::span<const std::uint8_t> UdpPayload(std::span<const std::uint8_t> frame, int link_type,
                                         std::span<const std::uint16_t> ports);

class LidarCapture {
 public:
  // Throws std::runtime_error when the file cannot be read or holds another kind of network.
  explicit LidarCapture(const std::filesystem::path& file);

  struct Datagram {
    std::int64_t stamp_ns = 0;
    std::span<const std::uint8_t> payload;  // valid until the next call
  };
  // False at the end. A capture that breaks off within a packet ends before it and sets truncated().
  bool Next(Datagram* datagram);
  [[nodiscard]] bool truncated() const { return truncated_; }

 private:
  struct Closer {
    void operator()(pcap* file) const;
  };
  std::unique_ptr<pcap, Closer> file_;
  int link_type_;
  bool truncated_ = false;
};

}  // namespace mapweld::replay
