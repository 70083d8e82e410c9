// SPDX-License-Identifier: Apache-2.0
// Rigid transforms. a_T_b maps points of frame b into frame a: p_a = a_T_b * p_b.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/geom/so3.hpp"

namespace mapweld::geom {

// Error and tangent order everywhere: translation (m), then rotation (rad).
using Vec6d = Eigen::Matrix<double, 6, 1>;
using Mat6d = Eigen::Matrix<double, 6, 6>;

struct Pose3 {
  Vec3d t = Vec3d::Zero();
  Quatd q = Quatd::Identity();

  [[nodiscard]] Vec3d operator*(const Vec3d& p) const { return q * p + t; }
  [[nodiscard]] Pose3 operator*(const Pose3& other) const { return {q * other.t + t, (q * other.q).normalized()}; }
  [[nodiscard]] Pose3 Inverse() const { return {-(q.conjugate() * t), q.conjugate()}; }
  // All numbers finite and the quaternion of unit length within 1e-3.
  [[nodiscard]] bool IsValid() const {
    return t.allFinite() && q.coeffs().allFinite() && std::abs(q.norm() - 1) < 1e-3;
  }
};

// Right perturbation on R^3 x SO(3): (t + q * d[0:3], q * Exp(d[3:6])).
Pose3 Retract(const Pose3& pose, const Vec6d& delta);
// The delta with Retract(from, delta) = to.
Vec6d LocalCoordinates(const Pose3& from, const Pose3& to);
// `odom_T_body` with roll and pitch removed: the gravity-aligned frame in which submaps and descriptors live.
Pose3 Level(const Pose3& odom_T_body);

}  // namespace mapweld::geom
