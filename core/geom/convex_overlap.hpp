// SPDX-License-Identifier: Apache-2.0
// Do two boxes in space touch? Decides which submaps can show the same things before anything is registered.
#pragma once

#include "core/geom/pose3.hpp"

namespace mapweld::geom {

// Axis-aligned in its own frame, centred at its origin.
struct OrientedBox {
  Pose3 world_T_box;
  Vec3d half_extent = Vec3d::Zero();  // m, not negative
};

// By libccd's Gilbert-Johnson-Keerthi intersection, at most 50 iterations, no heap. Boxes that touch within about 1e-4
// m may go either way. A box that is not finite overlaps nothing.
bool BoxesOverlap(const OrientedBox& a, const OrientedBox& b);

}  // namespace mapweld::geom
