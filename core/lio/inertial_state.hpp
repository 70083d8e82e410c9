// SPDX-License-Identifier: Apache-2.0
// The state of the error-state filter and its propagation by one IMU interval.
// Formulas: Sola, "Quaternion kinematics for the error-state Kalman filter", 2017, section 5.4, with the rotation error
// on the right (in the body) and the errors of position, velocity and gravity in `local`. `local` is the frame of the
// odometry's map: upright as far as the accelerometer could tell at the start. Gravity is part of the state, so what
// was wrong about that is learnt as soon as the vehicle has turned, without moving the map.
#pragma once

#include "core/geom/pose3.hpp"
#include "core/sensor/imu_sample.hpp"

namespace mapweld::lio {

// Order of the error state: position, rotation, velocity, gyro bias, accelerometer bias, gravity.
enum ErrorIndex : int {
  kPosition = 0,
  kRotation = 3,
  kVelocity = 6,
  kGyroBias = 9,
  kAccelBias = 12,
  kGravity = 15,
  kErrorDim = 18
};
using ErrorVector = Eigen::Matrix<double, kErrorDim, 1>;
using ErrorMatrix = Eigen::Matrix<double, kErrorDim, kErrorDim>;

struct InertialState {
  TimeNs t;
  geom::Pose3 local_T_body;
  geom::Vec3d v_local = geom::Vec3d::Zero();     // m/s
  geom::Vec3d gyro_bias = geom::Vec3d::Zero();   // rad/s
  geom::Vec3d accel_bias = geom::Vec3d::Zero();  // m/s^2
  geom::Vec3d gravity_local{0, 0, -9.81};        // m/s^2
};

struct ImuNoise {
  double gyro = 2e-3;             // rad/s/sqrt(Hz): sensor, vibration and the rounding of the CAN protocol together
  double accel = 1e-2;            // m/s^2/sqrt(Hz)
  double gyro_bias_walk = 1e-5;   // rad/s^2/sqrt(Hz)
  double accel_bias_walk = 1e-4;  // m/s^3/sqrt(Hz)
  double gravity_walk = 1e-2;     // m/s^2/sqrt(s): the map of a 16-beam LiDAR tilts as it grows, by 0.3 degrees in 30 s
};

// state + error.
InertialState Retract(const InertialState& state, const ErrorVector& error);
// The error with Retract(from, error) = to.
ErrorVector LocalCoordinates(const InertialState& from, const InertialState& to);

// Moves state and covariance on by dt_s > 0 with the mean angular rate and specific force of the interval. About 2500
// flops: the transition differs from the identity in eight 3 x 3 blocks.
void Propagate(const geom::Vec3d& gyro_body, const geom::Vec3d& accel_body, double dt_s, const ImuNoise& noise,
               InertialState* state, ErrorMatrix* covariance);

// The same without a measurement: constant velocity and rate of turn (rad/s), noise inflated to what a car can do in
// between.
void Coast(const geom::Vec3d& turn_body, double dt_s, InertialState* state, ErrorMatrix* covariance);

}  // namespace mapweld::lio
