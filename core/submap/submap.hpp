// SPDX-License-Identifier: Apache-2.0
// What a vehicle saw around one keyframe.
#pragma once

#include <cstdint>

#include "core/base/fixed_vector.hpp"
#include "core/base/time.hpp"
#include "core/config/capacity.hpp"

namespace mapweld::submap {

// Mean of the returns in one occupied voxel, in the keyframe's `level` frame (origin at the body, z up against gravity,
// x along the body's heading).
struct SubmapPoint {
  float x = 0;  // m
  float y = 0;
  float z = 0;
  std::uint16_t count = 0;  // returns in the voxel, saturating
  std::uint16_t reserved = 0;
};

// sizeof is about 0.8 MB: keep it in static memory or on the host's heap, never on a stack.
struct Submap {
  std::int32_t keyframe = -1;
  TimeNs t;
  float voxel_m = 0.5F;
  float radius_m = 50.0F;
  bool flushed = false;  // the drive ended before the vehicle was release_distance_m past the keyframe
  FixedVector<SubmapPoint, kCap.submap_points> points;  // along the Z-order curve of the cells
};

}  // namespace mapweld::submap
