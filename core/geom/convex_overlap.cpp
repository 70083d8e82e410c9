// SPDX-License-Identifier: Apache-2.0
#include "core/geom/convex_overlap.hpp"

#include <ccd/ccd.h>

namespace mapweld::geom {
namespace {

constexpr unsigned long kMaxIterations = 50;

Vec3d ToEigen(const ccd_vec3_t& v) {
  return {static_cast<double>(v.v[0]), static_cast<double>(v.v[1]), static_cast<double>(v.v[2])};
}

// The corner of the box furthest along `direction`.
void SupportOfBox(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
  const auto* box = static_cast<const OrientedBox*>(object);
  const Vec3d along = box->world_T_box.q.conjugate() * ToEigen(*direction);
  const Vec3d corner = (along.array() < 0).select(-box->half_extent, box->half_extent);
  const Vec3d p = box->world_T_box * corner;
  ccdVec3Set(out, static_cast<ccd_real_t>(p.x()), static_cast<ccd_real_t>(p.y()), static_cast<ccd_real_t>(p.z()));
}

bool IsUsable(const OrientedBox& box) {
  return box.world_T_box.IsValid() && box.half_extent.allFinite() && (box.half_extent.array() >= 0).all();
}

}  // namespace

bool BoxesOverlap(const OrientedBox& a, const OrientedBox& b) {
  if (!IsUsable(a) || !IsUsable(b)) return false;
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = SupportOfBox;
  ccd.support2 = SupportOfBox;
  ccd.max_iterations = kMaxIterations;
  return ccdGJKIntersect(&a, &b, &ccd) != 0;
}

}  // namespace mapweld::geom
