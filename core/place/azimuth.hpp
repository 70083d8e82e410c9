// SPDX-License-Identifier: Apache-2.0
// Azimuth by own arithmetic, because a library's atan2 may differ between machines.
#pragma once

#include <algorithm>
#include <cmath>

namespace mapweld::place {

// Azimuth of (x, y), not both 0, as a share 0..1 of a turn times `turn`. atan(t) ~ t (pi/4 + 0.273 (1 - t)) on 0..1:
// right to 0.22 degrees.
inline float Azimuth(float x, float y, float turn) {
  const float across = std::abs(y);
  const float along = std::abs(x);
  const float t = std::min(along, across) / std::max(along, across);
  const float eighth = turn / 8;
  const float bend = 0.273F * eighth / 0.78539816F;
  float azimuth = t * (eighth + bend * (1.0F - t));
  if (across > along) azimuth = 2 * eighth - azimuth;
  if (x < 0) azimuth = 4 * eighth - azimuth;
  if (y < 0) azimuth = 8 * eighth - azimuth;
  return azimuth;
}

}  // namespace mapweld::place
