// SPDX-License-Identifier: Apache-2.0
// Integer cells of a regular grid, packed into one word for hash tables.
#pragma once

#include <cmath>
#include <cstdint>

namespace mapweld {

struct Cell {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
};

inline constexpr std::int32_t kCellLimit = 1 << 20;  // cells run from -kCellLimit to kCellLimit - 1

// The cell that holds coordinate v (in units of the cell's edge). v must be finite and within the limit.
inline std::int32_t CellIndex(float v) {
  return static_cast<std::int32_t>(std::floor(v));
}

inline bool InLimits(const Cell& c) {
  return c.x >= -kCellLimit && c.x < kCellLimit && c.y >= -kCellLimit && c.y < kCellLimit && c.z >= -kCellLimit &&
         c.z < kCellLimit;
}

// 21 bits an axis, plus one, so that 0 can mean "free".
inline std::uint64_t PackCell(const Cell& c) {
  const auto bits = [](std::int32_t v) { return static_cast<std::uint64_t>(v + kCellLimit) & 0x1FFFFFU; };
  return ((bits(c.z) << 42U) | (bits(c.y) << 21U) | bits(c.x)) + 1;
}

inline Cell UnpackCell(std::uint64_t key) {
  const std::uint64_t k = key - 1;
  const auto axis = [](std::uint64_t v) { return static_cast<std::int32_t>(v & 0x1FFFFFU) - kCellLimit; };
  return {axis(k), axis(k >> 21U), axis(k >> 42U)};
}

// Mixes all bits of a key (the finaliser of splitmix64: Steele, Lea, Flood, OOPSLA 2014).
inline std::uint64_t HashKey(std::uint64_t k) {
  k ^= k >> 30U;
  k *= 0xBF58476D1CE4E5B9U;
  k ^= k >> 27U;
  k *= 0x94D049BB133111EBU;
  return k ^ (k >> 31U);
}

}  // namespace mapweld
