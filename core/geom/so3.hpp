// SPDX-License-Identifier: Apache-2.0
// Rotations: exponential and logarithm maps of SO(3) and their Jacobians.
// Formulas: Sola, Deray, Atchuthan, "A micro Lie theory for state estimation in robotics", 2018, eqs. 132-144.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace mapweld::geom {

using Vec3d = Eigen::Vector3d;
using Mat3d = Eigen::Matrix3d;
using Quatd = Eigen::Quaterniond;

// [v]_x, so that Skew(a) * b = a x b.
Mat3d Skew(const Vec3d& v);
// Rotation by |phi| rad about phi.
Quatd ExpSo3(const Vec3d& phi);
// The rotation vector of q, |result| <= pi. q must be of unit length.
Vec3d LogSo3(const Quatd& q);
// Right Jacobian: Exp(phi + d) ~ Exp(phi) Exp(Jr(phi) d), and its inverse.
Mat3d RightJacobianSo3(const Vec3d& phi);
Mat3d RightJacobianInverseSo3(const Vec3d& phi);
// Yaw about z in (-pi, pi] of a frame whose z axis is roughly up.
double Yaw(const Quatd& q);
// The smallest rotation that takes unit vector `from` to unit vector `to`.
Quatd RotationBetween(const Vec3d& from, const Vec3d& to);

}  // namespace mapweld::geom
