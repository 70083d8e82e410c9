// SPDX-License-Identifier: Apache-2.0
// The grid of a submap's own frame and the order of its points: along the Z-order curve of the cells (Morton, 1966), so
// that neighbours in space are neighbours in the list.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/submap/submap.hpp"

namespace mapweld::submap {

inline constexpr std::int32_t kHalfExtent = 128;  // cells run from -128 to 127 on each axis
inline constexpr unsigned kGridLevels = 8;        // bits per axis

// Puts the 8 bits of v three apart.
constexpr std::uint32_t SpreadBits(std::uint32_t v) {
  v = (v | (v << 8U)) & 0x00F00FU;
  v = (v | (v << 4U)) & 0x0C30C3U;
  return (v | (v << 2U)) & 0x249249U;
}

// The inverse of SpreadBits.
constexpr std::uint32_t GatherBits(std::uint32_t v) {
  v &= 0x249249U;
  v = (v | (v >> 2U)) & 0x0C30C3U;
  v = (v | (v >> 4U)) & 0x00F00FU;
  return (v | (v >> 8U)) & 0xFFU;
}

// 24 bits, z y x from the top of each triple. False when the point is not finite or outside the grid.
inline bool CellKey(const SubmapPoint& p, float voxel_m, std::uint32_t* key) {
  const float v[3] = {p.x / voxel_m, p.y / voxel_m, p.z / voxel_m};
  *key = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    if (!(v[axis] >= static_cast<float>(-kHalfExtent) && v[axis] < static_cast<float>(kHalfExtent))) return false;
    const std::int32_t cell = static_cast<std::int32_t>(std::floor(v[axis])) + kHalfExtent;
    *key |= SpreadBits(static_cast<std::uint32_t>(cell)) << axis;
  }
  return true;
}

}  // namespace mapweld::submap
