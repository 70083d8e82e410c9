// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace mapweld::store {

inline constexpr std::uint64_t kHashSeed = 0xCBF29CE484222325ULL;

// FNV-1a, 64 bits: tells things apart that are not made to look alike. Continue one with its result as the seed.
constexpr std::uint64_t Hash(std::span<const std::uint8_t> bytes, std::uint64_t seed = kHashSeed) {
  for (const std::uint8_t byte : bytes) {
    seed ^= byte;
    seed *= 0x100000001B3ULL;
  }
  return seed;
}

}  // namespace mapweld::store
