// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/time/receive_info.hpp"
#include "tools/spy/traffic.hpp"

namespace mapweld::spy {

// Listens to every datagram of an LCM network; sends nothing.
class LcmTap {
 public:
  // Throws one sentence, with the remedy, when the URL is wrong or the network cannot be joined.
  explicit LcmTap(const std::string& lcm_url);
  ~LcmTap();
  LcmTap(const LcmTap&) = delete;
  LcmTap& operator=(const LcmTap&) = delete;

  // Hands what comes within `wait` to *traffic, with the kernel's receive stamps. Returns early on a signal.
  void Listen(std::chrono::milliseconds wait, Traffic* traffic);

  // Datagrams that this program was too slow to take: they look as if the network had lost them.
  [[nodiscard]] std::uint64_t missed() const { return drops_.total(); }

 private:
  bool TakeOne(Traffic* traffic);

  int fd_ = -1;
  time::DropCounter drops_;
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(bus::kMaxDatagramBytes);
};

}  // namespace mapweld::spy
