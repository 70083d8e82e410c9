// SPDX-License-Identifier: Apache-2.0
// Submaps as bytes, for the wire and the spool: an octree of the occupied cells and the mean inside each cell on a grid
// of voxel_m / 16, entropy-coded. Decoding is exact to that grid. A street of 33000 points takes about 60 kB.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/submap/submap.hpp"
#include "core/submap/submap_models.hpp"

namespace mapweld::submap {

// Owns its scratch, 230 kB: keep it in static memory. No heap.
class SubmapEncoder {
 public:
  // Encodes into `out`; gives the bytes written. kBadInput: the points are not in the order that RollingMap gives them.
  // kOutOfRange: a point is not finite or more than 128 voxels from the origin. kFull: `out` is too small.
  // Cost: some 40 binary coding steps a point.
  Result<std::size_t> Encode(const Submap& submap, std::span<std::uint8_t> out);

  // The same in parts: Begin once, then Continue with the same submap until it no longer says kNotReady. Each call
  // codes at least max_points points and at most those of one cell more.
  Status Begin(const Submap& submap, std::span<std::uint8_t> out);
  Result<std::size_t> Continue(const Submap& submap, std::size_t max_points);

 private:
  std::array<std::uint32_t, kCap.submap_points> keys_{};
  SubmapModels models_;
  OctreeWalk walk_;
  std::size_t next_ = 0;  // point
  std::span<std::uint8_t> out_;
  RangeEncoder coder_{{}};
};

// 35 kB of stack. kBadInput, kVersion or kCrc on anything that SubmapEncoder did not write; *submap is then undefined
// but valid.
Status DecodeSubmap(std::span<const std::uint8_t> bytes, Submap* submap);

}  // namespace mapweld::submap
