// SPDX-License-Identifier: Apache-2.0
// Submaps as bytes, for the wire and the spool: voxel cells delta-coded in scan order, the mean inside its cell on a
// grid of voxel_m / 32. Decoding is exact to that grid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/submap/submap.hpp"

namespace mapweld::submap {

// Encodes into `out`; gives the bytes written or kFull. Cost: one pass over the points, which must be ordered by voxel.
Result<std::size_t> EncodeSubmap(const Submap& submap, std::span<std::uint8_t> out);

// kBadInput, kVersion or kCrc on anything that EncodeSubmap did not write; *submap is then undefined but valid.
Status DecodeSubmap(std::span<const std::uint8_t> bytes, Submap* submap);

}  // namespace mapweld::submap
