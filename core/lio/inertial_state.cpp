// SPDX-License-Identifier: Apache-2.0
#include "core/lio/inertial_state.hpp"

namespace mapweld::lio {
namespace {

// What a car may do unseen: 0.5 rad/s of turning, 3 m/s^2 of acceleration, as white noise over 1 s.
constexpr double kCoastGyro = 0.5;
constexpr double kCoastAccel = 3.0;

void AddNoise(double gyro, double accel, const ImuNoise& noise, double dt_s, ErrorMatrix* covariance) {
  const auto add = [&](int at, double density) {
    for (int i = 0; i < 3; ++i) (*covariance)(at + i, at + i) += density * density * dt_s;
  };
  add(kRotation, gyro);
  add(kVelocity, accel);
  add(kGyroBias, noise.gyro_bias_walk);
  add(kAccelBias, noise.accel_bias_walk);
  add(kGravity, noise.gravity_walk);
}

// The blocks in which the transition of the error differs from the identity; position from velocity and gravity, and
// velocity from gravity, are multiples of the identity by dt.
struct Transition {
  double dt_s = 0;
  geom::Mat3d position_from_rotation = geom::Mat3d::Zero();
  geom::Mat3d velocity_from_rotation = geom::Mat3d::Zero();
  geom::Mat3d velocity_from_accel_bias = geom::Mat3d::Zero();
  geom::Mat3d rotation_from_rotation = geom::Mat3d::Identity();
  geom::Mat3d rotation_from_gyro_bias = geom::Mat3d::Zero();
  double gravity = 0;  // 1: gravity acts; 0: constant velocity

  void ApplyLeft(ErrorMatrix* m) const {
    const auto rows = [m](int at) { return m->middleRows<3>(at); };
    rows(kPosition) += dt_s * rows(kVelocity) + (0.5 * dt_s * dt_s * gravity) * rows(kGravity);
    rows(kPosition).noalias() += position_from_rotation * rows(kRotation);
    rows(kVelocity) += (dt_s * gravity) * rows(kGravity);
    rows(kVelocity).noalias() += velocity_from_rotation * rows(kRotation);
    rows(kVelocity).noalias() += velocity_from_accel_bias * rows(kAccelBias);
    const Eigen::Matrix<double, 3, kErrorDim> rotation =
        rotation_from_rotation * rows(kRotation) + rotation_from_gyro_bias * rows(kGyroBias);
    rows(kRotation) = rotation;
  }
  // F P F'.
  void Apply(ErrorMatrix* covariance) const {
    ApplyLeft(covariance);
    covariance->transposeInPlace();
    ApplyLeft(covariance);
  }
};

}  // namespace

InertialState Retract(const InertialState& state, const ErrorVector& error) {
  InertialState out = state;
  out.local_T_body.t += error.segment<3>(kPosition);
  out.local_T_body.q = (state.local_T_body.q * geom::ExpSo3(error.segment<3>(kRotation))).normalized();
  out.v_local += error.segment<3>(kVelocity);
  out.gyro_bias += error.segment<3>(kGyroBias);
  out.accel_bias += error.segment<3>(kAccelBias);
  out.gravity_local += error.segment<3>(kGravity);
  return out;
}

ErrorVector LocalCoordinates(const InertialState& from, const InertialState& to) {
  ErrorVector error;
  error.segment<3>(kPosition) = to.local_T_body.t - from.local_T_body.t;
  error.segment<3>(kRotation) = geom::LogSo3((from.local_T_body.q.conjugate() * to.local_T_body.q).normalized());
  error.segment<3>(kVelocity) = to.v_local - from.v_local;
  error.segment<3>(kGyroBias) = to.gyro_bias - from.gyro_bias;
  error.segment<3>(kAccelBias) = to.accel_bias - from.accel_bias;
  error.segment<3>(kGravity) = to.gravity_local - from.gravity_local;
  return error;
}

void Propagate(const geom::Vec3d& gyro_body, const geom::Vec3d& accel_body, double dt_s, const ImuNoise& noise,
               InertialState* state, ErrorMatrix* covariance) {
  const geom::Vec3d rotation = (gyro_body - state->gyro_bias) * dt_s;
  const geom::Vec3d force = accel_body - state->accel_bias;
  // The specific force acts, on average, in the orientation at the middle of the interval.
  const geom::Quatd q_mid = state->local_T_body.q * geom::ExpSo3(0.5 * rotation);
  const geom::Mat3d r_mid = q_mid.toRotationMatrix();
  const geom::Vec3d accel_local = r_mid * force + state->gravity_local;
  const geom::Quatd turn = geom::ExpSo3(rotation);

  Transition f;
  f.dt_s = dt_s;
  f.velocity_from_rotation = -dt_s * r_mid * geom::Skew(force);
  f.position_from_rotation = 0.5 * dt_s * f.velocity_from_rotation;
  f.velocity_from_accel_bias = -dt_s * r_mid;
  f.rotation_from_rotation = turn.toRotationMatrix().transpose();
  f.rotation_from_gyro_bias = -dt_s * geom::RightJacobianSo3(rotation);
  f.gravity = 1;
  f.Apply(covariance);
  AddNoise(noise.gyro, noise.accel, noise, dt_s, covariance);

  state->local_T_body.t += state->v_local * dt_s + 0.5 * dt_s * dt_s * accel_local;
  state->v_local += accel_local * dt_s;
  state->local_T_body.q = (state->local_T_body.q * turn).normalized();
  state->t = state->t + FromSeconds(dt_s);
}

void Coast(const geom::Vec3d& turn_body, double dt_s, InertialState* state, ErrorMatrix* covariance) {
  const geom::Quatd turn = geom::ExpSo3(turn_body * dt_s);
  Transition f;
  f.dt_s = dt_s;
  f.rotation_from_rotation = turn.toRotationMatrix().transpose();
  f.Apply(covariance);
  AddNoise(kCoastGyro, kCoastAccel, ImuNoise{}, dt_s, covariance);
  state->local_T_body.t += state->v_local * dt_s;
  state->local_T_body.q = (state->local_T_body.q * turn).normalized();
  state->t = state->t + FromSeconds(dt_s);
}

}  // namespace mapweld::lio
