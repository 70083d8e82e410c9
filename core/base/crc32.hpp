// SPDX-License-Identifier: Apache-2.0
// CRC-32 (IEEE 802.3, reflected, 0xEDB88320), the one of zlib and Ethernet.
#pragma once

#include <cstdint>
#include <span>

namespace mapweld {

// seed: the result of an earlier call to continue it. One table look-up per byte.
std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t seed = 0);

}  // namespace mapweld
