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
}

}  // namespace

InertialState Retract(const InertialState& state, const ErrorVector& error) {
  InertialState out = state;
  out.odom_T_body.t += error.segment<3>(kPosition);
  out.odom_T_body.q = (state.odom_T_body.q * geom::ExpSo3(error.segment<3>(kRotation))).normalized();
  out.v_odom += error.segment<3>(kVelocity);
  out.gyro_bias += error.segment<3>(kGyroBias);
  out.accel_bias += error.segment<3>(kAccelBias);
  return out;
}

ErrorVector LocalCoordinates(const InertialState& from, const InertialState& to) {
  ErrorVector error;
  error.segment<3>(kPosition) = to.odom_T_body.t - from.odom_T_body.t;
  error.segment<3>(kRotation) = geom::LogSo3((from.odom_T_body.q.conjugate() * to.odom_T_body.q).normalized());
  error.segment<3>(kVelocity) = to.v_odom - from.v_odom;
  error.segment<3>(kGyroBias) = to.gyro_bias - from.gyro_bias;
  error.segment<3>(kAccelBias) = to.accel_bias - from.accel_bias;
  return error;
}

void Propagate(const geom::Vec3d& gyro_body, const geom::Vec3d& accel_body, double dt_s, double gravity_m_s2,
               const ImuNoise& noise, InertialState* state, ErrorMatrix* covariance) {
  const geom::Vec3d rotation = (gyro_body - state->gyro_bias) * dt_s;
  const geom::Vec3d force = accel_body - state->accel_bias;
  // The specific force acts, on average, in the orientation at the middle of the interval.
  const geom::Quatd q_mid = state->odom_T_body.q * geom::ExpSo3(0.5 * rotation);
  const geom::Vec3d accel_odom = q_mid * force - gravity_m_s2 * geom::Vec3d::UnitZ();
  const geom::Mat3d r_mid = q_mid.toRotationMatrix();

  ErrorMatrix f = ErrorMatrix::Identity();
  f.block<3, 3>(kPosition, kVelocity).diagonal().setConstant(dt_s);
  f.block<3, 3>(kPosition, kRotation) = -0.5 * dt_s * dt_s * r_mid * geom::Skew(force);
  f.block<3, 3>(kRotation, kRotation) = geom::ExpSo3(-rotation).toRotationMatrix();
  f.block<3, 3>(kRotation, kGyroBias) = -dt_s * geom::RightJacobianSo3(rotation);
  f.block<3, 3>(kVelocity, kRotation) = -dt_s * r_mid * geom::Skew(force);
  f.block<3, 3>(kVelocity, kAccelBias) = -dt_s * r_mid;
  const ErrorMatrix fp = f * (*covariance);
  *covariance = fp * f.transpose();
  AddNoise(noise.gyro, noise.accel, noise, dt_s, covariance);

  state->odom_T_body.t += state->v_odom * dt_s + 0.5 * dt_s * dt_s * accel_odom;
  state->v_odom += accel_odom * dt_s;
  state->odom_T_body.q = (state->odom_T_body.q * geom::ExpSo3(rotation)).normalized();
  state->t = state->t + FromSeconds(dt_s);
}

void Coast(double dt_s, InertialState* state, ErrorMatrix* covariance) {
  ErrorMatrix f = ErrorMatrix::Identity();
  f.block<3, 3>(kPosition, kVelocity).diagonal().setConstant(dt_s);
  const ErrorMatrix fp = f * (*covariance);
  *covariance = fp * f.transpose();
  AddNoise(kCoastGyro, kCoastAccel, ImuNoise{}, dt_s, covariance);
  state->odom_T_body.t += state->v_odom * dt_s;
  state->t = state->t + FromSeconds(dt_s);
}

}  // namespace mapweld::lio
