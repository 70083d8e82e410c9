// SPDX-License-Identifier: Apache-2.0
#include "drivers/bus/lcm_url.hpp"

#include <cstddef>

namespace mapweld::bus {
namespace {

// Takes a decimal number of 1 to 10 digits and at most `max` off the front.
bool TakeNumber(std::string_view* rest, std::uint64_t max, std::uint64_t* value) {
  std::size_t digits = 0;
  *value = 0;
  while (digits < rest->size() && (*rest)[digits] >= '0' && (*rest)[digits] <= '9') {
    if (digits == 10) return false;
    *value = *value * 10 + static_cast<std::uint64_t>((*rest)[digits++] - '0');
  }
  rest->remove_prefix(digits);
  return digits > 0 && *value <= max;
}

bool TakeLiteral(std::string_view* rest, std::string_view literal) {
  if (!rest->starts_with(literal)) return false;
  rest->remove_prefix(literal.size());
  return true;
}

bool TakeGroup(std::string_view* rest, std::uint32_t* ipv4) {
  *ipv4 = 0;
  for (int i = 0; i < 4; ++i) {
    if (i > 0 && !TakeLiteral(rest, ".")) return false;
    std::uint64_t octet = 0;
    if (!TakeNumber(rest, 255, &octet)) return false;
    *ipv4 = (*ipv4 << 8U) | static_cast<std::uint32_t>(octet);
  }
  return (*ipv4 >> 28U) == 0xE;  // 224.0.0.0 to 239.255.255.255
}

bool TakeOption(std::string_view* rest, UdpmAddress* address, unsigned* seen) {
  std::uint64_t value = 0;
  unsigned bit = 0;
  if (TakeLiteral(rest, "ttl=")) {
    bit = 1;
    if (!TakeNumber(rest, 255, &value)) return false;
    address->ttl = static_cast<std::uint8_t>(value);
  } else if (TakeLiteral(rest, "recv_buf_size=")) {
    bit = 2;
    if (!TakeNumber(rest, 0x3FFFFFFF, &value) || value == 0) return false;
    address->receive_buffer_bytes = static_cast<std::uint32_t>(value);
  } else {
    return false;
  }
  const bool repeated = (*seen & bit) != 0;
  *seen |= bit;
  return !repeated;
}

}  // namespace

Status ParseLcmUrl(std::string_view url, UdpmAddress* address) {
  UdpmAddress parsed;
  if (!TakeLiteral(&url, "udpm://")) return Status::kBadInput;
  if (!url.empty() && url.front() != ':' && url.front() != '?' && !TakeGroup(&url, &parsed.group_ipv4)) {
    return Status::kBadInput;
  }
  if (TakeLiteral(&url, ":")) {
    std::uint64_t port = 0;
    if (!TakeNumber(&url, 65535, &port) || port == 0) return Status::kBadInput;
    parsed.port = static_cast<std::uint16_t>(port);
  }
  if (TakeLiteral(&url, "?") && !url.empty()) {
    unsigned seen = 0;
    do {
      if (!TakeOption(&url, &parsed, &seen)) return Status::kBadInput;
    } while (TakeLiteral(&url, "&"));
  }
  if (!url.empty()) return Status::kBadInput;
  *address = parsed;
  return Status::kOk;
}

}  // namespace mapweld::bus
