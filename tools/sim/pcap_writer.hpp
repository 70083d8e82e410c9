// SPDX-License-Identifier: Apache-2.0
// A capture file (classic pcap, nanosecond stamps) of UDP datagrams as a VLP-16 sends them: from 192.168.1.201 to
// everybody on the network, port 2368.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "tools/sim/output_file.hpp"

namespace mapweld::sim {

inline constexpr std::uint16_t kVelodynePort = 2368;

class PcapWriter {
 public:
  explicit PcapWriter(const std::filesystem::path& path);
  void Write(std::int64_t stamp_ns, std::span<const std::uint8_t> udp_payload);  // at most 1472 bytes
  void Close() { file_.Close(); }

 private:
  OutputFile file_;
};

}  // namespace mapweld::sim
