// SPDX-License-Identifier: Apache-2.0
#include "core/geom/so3.hpp"

#include <cmath>

namespace mapweld::geom {
namespace {
constexpr double kSmallAngle = 1e-6;
}

Mat3d Skew(const Vec3d& v) {
  Mat3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Quatd ExpSo3(const Vec3d& phi) {
  const double angle = phi.norm();
  if (angle < kSmallAngle) return Quatd(1.0, 0.5 * phi.x(), 0.5 * phi.y(), 0.5 * phi.z()).normalized();
  const Vec3d v = phi * (std::sin(0.5 * angle) / angle);
  return {std::cos(0.5 * angle), v.x(), v.y(), v.z()};
}

Vec3d LogSo3(const Quatd& q) {
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const Vec3d v = sign * q.vec();
  const double n = v.norm();
  if (n < kSmallAngle) return 2.0 * v;
  return (2.0 * std::atan2(n, sign * q.w()) / n) * v;
}

Mat3d RightJacobianSo3(const Vec3d& phi) {
  const double a = phi.norm();
  const Mat3d w = Skew(phi);
  if (a < 1e-4) return Mat3d::Identity() - 0.5 * w + w * w / 6.0;
  return Mat3d::Identity() - (1 - std::cos(a)) / (a * a) * w + (a - std::sin(a)) / (a * a * a) * w * w;
}

Mat3d RightJacobianInverseSo3(const Vec3d& phi) {
  const double a = phi.norm();
  const Mat3d w = Skew(phi);
  if (a < 1e-4) return Mat3d::Identity() + 0.5 * w + w * w / 12.0;
  return Mat3d::Identity() + 0.5 * w + (1 / (a * a) - (1 + std::cos(a)) / (2 * a * std::sin(a))) * w * w;
}

double Yaw(const Quatd& q) {
  return std::atan2(2 * (q.w() * q.z() + q.x() * q.y()), 1 - 2 * (q.y() * q.y() + q.z() * q.z()));
}

Quatd RotationBetween(const Vec3d& from, const Vec3d& to) {
  return Quatd::FromTwoVectors(from, to);
}

}  // namespace mapweld::geom
