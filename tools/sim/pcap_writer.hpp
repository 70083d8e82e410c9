// SPDX-License-Identifier: Apache-2.0
// A capture file (classic pcap, nanosecond stamps) of UDP datagrams as a LiDAR sends them: from 192.168.1.201 to
// everybody on the network.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "tools/sim/output_file.hpp"

namespace mapweld::sim {

class PcapWriter {
 public:
  PcapWriter(const std::filesystem::path& path, std::uint16_t udp_port);
  // At most 65 493 bytes. What is too long for one frame on the wire stands there as the receiver puts it together.
  void Write(std::int64_t stamp_ns, std::span<const std::uint8_t> udp_payload);
  void Close() { file_.Close(); }

 private:
  OutputFile file_;
  std::uint16_t udp_port_;
};

}  // namespace mapweld::sim
