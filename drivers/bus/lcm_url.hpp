// SPDX-License-Identifier: Apache-2.0
// Reads an LCM address of the UDP multicast kind: udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4000000
// Address, port and options may each be left out. Other transports are for host programs.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/base/status.hpp"

namespace mapweld::bus {

struct UdpmAddress {
  std::uint32_t group_ipv4 = 0xEFFF4C43;  // 239.255.76.67, host byte order
  std::uint16_t port = 7667;
  std::uint8_t ttl = 0;  // 0 keeps the messages on this machine
  std::uint32_t receive_buffer_bytes = 4U << 20U;
};

// kBadInput for another scheme, an address that is not multicast, an unknown or repeated option, trailing characters.
Status ParseLcmUrl(std::string_view url, UdpmAddress* address);

}  // namespace mapweld::bus
