// SPDX-License-Identifier: Apache-2.0
// What a place looks like, as 1024 small integers, and which way it was seen, as 192 more.
#pragma once

#include <array>
#include <cstdint>

namespace mapweld::place {

inline constexpr int kDescriptorDim = 1024;
inline constexpr int kSignatureDim = 192;

// value[i] = scale * q[i]; of unit length up to rounding. Invariant to the heading of the vehicle.
struct PlaceDescriptor {
  std::array<std::int8_t, kDescriptorDim> q{};
  float scale = 0;
};

// Azimuth profiles of the place; they shift cyclically with the heading. q[0..63] repeats after half a turn (directions
// of walls and kerbs), q[64..127] and q[128..191] after a full one (structure near and far).
struct OrientationSignature {
  std::array<std::int8_t, kSignatureDim> q{};
  float scale = 0;
};

struct PlaceDescription {
  PlaceDescriptor descriptor;
  OrientationSignature orientation;
};

// Cosine distance 0..2; exactly 0 between equal descriptors, 1 to one of zeros, never NaN whatever the bytes. Integer
// arithmetic inside: the same bits on every machine. 3 x 1024 multiply-adds.
float CosineDistance(const PlaceDescriptor& a, const PlaceDescriptor& b);

struct RelativeYaw {
  float yaw_rad = 0;  // heading of b in the level frame of a: a_T_b = translation * Rz(yaw)
  float score = 0;    // normalised correlation at the peak, -1..1
};
// The yaw between two views of one place by cyclic correlation of their signatures, 1/128 turn a step, a parabola
// between steps. Score 0 for a signature of zeros. 3 x 64 x 64 integer multiply-adds.
RelativeYaw EstimateRelativeYaw(const OrientationSignature& a, const OrientationSignature& b);

}  // namespace mapweld::place
