// SPDX-License-Identifier: Apache-2.0
#include "core/lio/inertial_state.hpp"

#include <gtest/gtest.h>

#include <random>

namespace mapweld::lio {
namespace {

InertialState SomeState() {
  InertialState s;
  s.local_T_body = {{1, 2, 3}, geom::ExpSo3({0.1, -0.2, 0.7})};
  s.v_local = {3, -1, 0.2};
  s.gyro_bias = {0.01, -0.02, 0.005};
  s.accel_bias = {0.1, 0.05, -0.08};
  return s;
}

TEST(InertialState, RetractUndoesLocalCoordinates) {
  const InertialState a = SomeState();
  ErrorVector error;
  for (int i = 0; i < kErrorDim; ++i) error(i) = 0.01 * (i + 1);
  EXPECT_LT((LocalCoordinates(a, Retract(a, error)) - error).norm(), 1e-10);
}

TEST(InertialState, StaysPutUnderGravityAlone) {
  InertialState s;
  ErrorMatrix p = ErrorMatrix::Identity() * 1e-6;
  for (int i = 0; i < 1000; ++i) Propagate({0, 0, 0}, {0, 0, 9.81}, 0.005, {}, &s, &p);
  EXPECT_LT(s.local_T_body.t.norm(), 1e-9);
  EXPECT_LT(s.v_local.norm(), 1e-9);
}

TEST(InertialState, PropagatesACircle) {
  // 10 m/s on a radius of 20 m: one turn later it is back.
  const double omega = 0.5;
  InertialState s;
  s.v_local = {10, 0, 0};
  ErrorMatrix p = ErrorMatrix::Identity() * 1e-6;
  const double turn_s = 2 * 3.14159265358979 / omega;
  const int n = 5000;
  for (int i = 0; i < n; ++i) Propagate({0, 0, omega}, {0, 10 * omega, 9.81}, turn_s / n, {}, &s, &p);
  EXPECT_LT(s.local_T_body.t.norm(), 1e-3);
  EXPECT_LT((s.v_local - geom::Vec3d(10, 0, 0)).norm(), 1e-3);
}

TEST(InertialState, CovarianceFollowsTheNumericJacobian) {
  const InertialState s0 = SomeState();
  const geom::Vec3d gyro(0.3, -0.2, 0.5);
  const geom::Vec3d accel(1, 2, 9);
  const double dt = 0.005;
  const auto step = [&](InertialState s) {
    ErrorMatrix unused = ErrorMatrix::Zero();
    Propagate(gyro, accel, dt, {}, &s, &unused);
    return s;
  };
  Eigen::Matrix<double, kErrorDim, kErrorDim> f;
  const double h = 1e-6;
  for (int k = 0; k < kErrorDim; ++k) {
    f.col(k) = LocalCoordinates(step(s0), step(Retract(s0, h * ErrorVector::Unit(k)))) / h;
  }
  ErrorVector sigma;
  for (int i = 0; i < kErrorDim; ++i) sigma(i) = 0.1 * (i + 1);
  const ErrorMatrix p0 = sigma.cwiseProduct(sigma).asDiagonal();
  ErrorMatrix p = p0;
  InertialState s = s0;
  ImuNoise silent{0, 0, 0, 0, 0};
  Propagate(gyro, accel, dt, silent, &s, &p);
  EXPECT_LT((p - f * p0 * f.transpose()).norm() / p.norm(), 1e-4);
}

TEST(InertialState, CoastingGoesOnTurningAtTheLastKnownRate) {
  InertialState s;
  s.v_local = {2, 0, 0};
  ErrorMatrix p = ErrorMatrix::Identity() * 1e-6;
  for (int i = 0; i < 100; ++i) Coast({0, 0, 0.5}, 0.01, &s, &p);
  EXPECT_NEAR(geom::Yaw(s.local_T_body.q), 0.5, 1e-9);
  EXPECT_NEAR(s.local_T_body.t.x(), 2, 1e-9);
}

TEST(InertialState, CoastingGrowsTheUncertaintyMuchFasterThanMeasuring) {
  InertialState a = SomeState();
  InertialState b = a;
  ErrorMatrix pa = ErrorMatrix::Identity() * 1e-6;
  ErrorMatrix pb = pa;
  for (int i = 0; i < 200; ++i) {
    Propagate({0, 0, 0}, {0, 0, 9.81}, 0.005, {}, &a, &pa);
    Coast({0, 0, 0}, 0.005, &b, &pb);
  }
  EXPECT_GT(pb(0, 0), 100 * pa(0, 0));
}

}  // namespace
}  // namespace mapweld::lio
