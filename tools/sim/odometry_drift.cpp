// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/odometry_drift.hpp"

#include <cmath>

#include "core/geom/so3.hpp"
#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {

DriftingOdometry::DriftingOdometry(const OdometryModel& model, std::uint64_t seed)
    : model_(model),
      seed_(seed),
      scale_(1 + model.scale * Gaussian(Hash(seed, 1))),
      tilt_(geom::ExpSo3(model.tilt_rad * geom::Vec3d(Gaussian(Hash(seed, 2)), Gaussian(Hash(seed, 3)), 0))) {}

geom::Pose3 DriftingOdometry::Next(const geom::Pose3& world_T_body) {
  if (steps_ == 0) {
    const double yaw = geom::Yaw(world_T_body.q);
    walked_.q = geom::ExpSo3({0, 0, -yaw}) * world_T_body.q;  // level, looking along x
  } else {
    geom::Pose3 step = true_before_.Inverse() * world_T_body;
    const double root_m = std::sqrt(step.t.norm());
    step.t *= scale_;
    walked_ = walked_ * step;
    const double turn = model_.yaw_walk_rad * root_m * Gaussian(Hash(seed_, 4, steps_));
    walked_.q = (geom::ExpSo3({0, 0, turn}) * walked_.q).normalized();
    walked_.t.z() += model_.height_walk_m * root_m * Gaussian(Hash(seed_, 5, steps_));
  }
  true_before_ = world_T_body;
  ++steps_;
  return {tilt_ * walked_.t, (tilt_ * walked_.q).normalized()};
}

}  // namespace mapweld::sim
