// SPDX-License-Identifier: Apache-2.0
#include "core/geom/pose3.hpp"

namespace mapweld::geom {

Pose3 Retract(const Pose3& pose, const Vec6d& delta) {
  return {pose.t + pose.q * delta.head<3>(), (pose.q * ExpSo3(delta.tail<3>())).normalized()};
}

Vec6d LocalCoordinates(const Pose3& from, const Pose3& to) {
  Vec6d delta;
  delta.head<3>() = from.q.conjugate() * (to.t - from.t);
  delta.tail<3>() = LogSo3((from.q.conjugate() * to.q).normalized());
  return delta;
}

Pose3 Level(const Pose3& odom_T_body) {
  return {odom_T_body.t, Quatd(Eigen::AngleAxisd(Yaw(odom_T_body.q), Vec3d::UnitZ()))};
}

}  // namespace mapweld::geom
