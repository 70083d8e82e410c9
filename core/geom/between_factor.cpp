// SPDX-License-Identifier: Apache-2.0
#include "core/geom/between_factor.hpp"

namespace mapweld::geom {

Vec6d BetweenResidual(const Pose3& world_T_a, const Pose3& world_T_b, const Pose3& measured_a_T_b) {
  return LocalCoordinates(measured_a_T_b, world_T_a.Inverse() * world_T_b);
}

BetweenLinearization LinearizeBetween(const Pose3& world_T_a, const Pose3& world_T_b, const Pose3& measured_a_T_b) {
  const Pose3 a_T_b = world_T_a.Inverse() * world_T_b;
  BetweenLinearization out;
  out.residual = LocalCoordinates(measured_a_T_b, a_T_b);
  const Mat3d measured_R_inverse = measured_a_T_b.q.conjugate().toRotationMatrix();
  const Mat3d a_R_b = a_T_b.q.toRotationMatrix();
  const Mat3d jr_inverse = RightJacobianInverseSo3(out.residual.tail<3>());
  // a_T_b after perturbing a: t' = Exp(-w)(t - v), R' = Exp(-w) R.  After perturbing b: t' = t + R v, R' = R Exp(w).
  out.jacobian_a.setZero();
  out.jacobian_a.topLeftCorner<3, 3>() = -measured_R_inverse;
  out.jacobian_a.topRightCorner<3, 3>() = measured_R_inverse * Skew(a_T_b.t);
  out.jacobian_a.bottomRightCorner<3, 3>() = -jr_inverse * a_R_b.transpose();
  out.jacobian_b.setZero();
  out.jacobian_b.topLeftCorner<3, 3>() = measured_R_inverse * a_R_b;
  out.jacobian_b.bottomRightCorner<3, 3>() = jr_inverse;
  return out;
}

}  // namespace mapweld::geom
