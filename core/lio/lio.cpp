// SPDX-License-Identifier: Apache-2.0
#include "core/lio/lio.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace mapweld::lio {
namespace {

constexpr double kFirstGateM[] = {0.6, 0.4, 0.25};  // correspondence gate of the first iterations

ErrorMatrix Diagonal(double position, double rotation, double velocity, double gyro_bias, double accel_bias,
                     double gravity) {
  ErrorVector sigma;
  sigma.segment<3>(kPosition).setConstant(position);
  sigma.segment<3>(kRotation).setConstant(rotation);
  sigma.segment<3>(kVelocity).setConstant(velocity);
  sigma.segment<3>(kGyroBias).setConstant(gyro_bias);
  sigma.segment<3>(kAccelBias).setConstant(accel_bias);
  sigma.segment<3>(kGravity).setConstant(gravity);
  return sigma.cwiseProduct(sigma).asDiagonal();
}

// Pose: local starts here by definition. At rest the accelerometer measured bias minus gravity exactly, so what is
// unknown of the one is unknown of the other until the vehicle turns.
ErrorMatrix CovarianceAtRest(const geom::Quatd& local_R_body) {
  constexpr double kBias = 3e-2;
  ErrorMatrix covariance = Diagonal(1e-4, 1e-4, 1e-2, 2e-3, kBias, kBias);
  const geom::Mat3d cross = kBias * kBias * local_R_body.toRotationMatrix();
  covariance.block<3, 3>(kGravity, kAccelBias) = cross;
  covariance.block<3, 3>(kAccelBias, kGravity) = cross.transpose();
  covariance.block<3, 3>(kGravity, kGravity).diagonal().array() += 5e-3 * 5e-3;
  return covariance;
}

ErrorMatrix CovarianceInMotion() {
  return Diagonal(1e-4, 1e-4, 20, 5e-3, 3e-2, 1.0);
}

}  // namespace

Status Lio::AddImu(const sensor::ImuSample& sample) {
  if (!sample.gyro_body.allFinite() || !sample.accel_body.allFinite()) return Status::kBadInput;
  if (sample.t <= newest_imu_) {
    if (++stale_in_a_row_ < kResyncSamples) return Status::kStale;
    imu_.clear();
  }
  stale_in_a_row_ = 0;
  newest_imu_ = sample.t;
  if (IsStuck(sample) || (aligned_ && sample.clipped)) return Status::kBadInput;
  if (aligned_) {
    if (imu_.size() == imu_.capacity()) Step(imu_[imu_.size() / 2].t);  // no scan for long: the state moves on without
    imu_.Push(sample);
    return Status::kOk;
  }
  const Status status = alignment_.Add(sample);
  if (status != Status::kOk) return status == Status::kNotReady ? Status::kOk : status;
  StartFromAlignment(sample.t);
  imu_.Push(sample);
  return Status::kOk;
}

bool Lio::IsStuck(const sensor::ImuSample& sample) {
  const bool same = sample.gyro_body == last_imu_.gyro_body && sample.accel_body == last_imu_.accel_body;
  repeats_ = same ? repeats_ + 1 : 0;
  last_imu_ = sample;
  return repeats_ >= kStuckSamples;
}

void Lio::StartFromAlignment(TimeNs t) {
  const Alignment& found = alignment_.alignment();
  aligned_ = true;
  speed_unknown_ = true;
  state_.t = t;
  state_.local_T_body.q = found.local_R_body;
  state_.gyro_bias = found.gyro_bias;
  state_.gravity_local = {0, 0, -found.gravity_m_s2};
  covariance_ = found.moving ? CovarianceInMotion() : CovarianceAtRest(found.local_R_body);
  scan_state_ = state_;
}

void Lio::StartWithoutImu(TimeNs t) {
  aligned_ = true;
  speed_unknown_ = true;
  state_.t = t;
  scan_state_ = state_;
  covariance_ = CovarianceInMotion();
}

Status Lio::AddScan(const sensor::Scan& scan, LioUpdate* update) {
  if (!aligned_ && config_.use_imu) return Status::kNotReady;
  if (scan.points.empty() || scan.t_end <= scan.t_begin) return Status::kBadInput;
  if (!aligned_) StartWithoutImu(scan.t_begin);
  if (scan.t_end <= state_.t) return Status::kStale;

  PredictTo(scan.t_begin, scan.t_end);
  scan::Deskew(scan, motion_, config_.body_T_lidar, config_.deskew, &body_points_);
  downsample_.Run(body_points_, config_.feature_voxel_m, &features_);

  *update = LioUpdate{};
  update->t = scan.t_end;
  update->features = static_cast<int>(features_.size());
  map_.BeginScan();
  if (has_map_ && speed_unknown_) GuessSpeed();
  if (has_map_) UpdateFromScan(update);
  if (speed_unknown_ && update->corrected) BeginMapAgain(scan);
  uncorrected_scans_ = update->corrected || !has_map_ ? 0 : uncorrected_scans_ + 1;
  if (uncorrected_scans_ == 0 || uncorrected_scans_ > config_.max_uncorrected_scans) GrowMap();
  Publish(update);
  return Status::kOk;
}

// Do the two oldest samples cover the time after the state, without a gap?
bool Lio::Measured() const {
  return imu_.size() > 1 && imu_[0].t <= state_.t && (imu_[1].t - imu_[0].t).Seconds() <= config_.max_imu_gap_s;
}

// Carries the state on to t_end or to the next IMU sample, whichever comes first.
void Lio::Step(TimeNs t_end) {
  while (imu_.size() > 1 && imu_[1].t <= state_.t) imu_.PopFront();  // imu_[0] is now the last at or before the state
  TimeNs until = t_end;
  for (std::size_t i = 0; i < std::min<std::size_t>(imu_.size(), 2); ++i) {
    if (imu_[i].t > state_.t) {
      until = std::min(until, imu_[i].t);
      break;
    }
  }
  const double dt = (until - state_.t).Seconds();
  if (Measured()) {
    const geom::Vec3d gyro = 0.5 * (imu_[0].gyro_body + imu_[1].gyro_body);
    const geom::Vec3d accel = 0.5 * (imu_[0].accel_body + imu_[1].accel_body);
    turn_body_ = gyro - state_.gyro_bias;
    Propagate(gyro, accel, dt, config_.imu_noise, &state_, &covariance_);
  } else {
    coasted_.ns += (until - state_.t).ns;
    Coast(turn_body_, dt, &state_, &covariance_);
  }
  state_.t = until;  // exact, whatever the rounding of dt
}

// Carries the state to t_end and records the body's motion over [t_begin, t_end] for de-skewing.
void Lio::PredictTo(TimeNs t_begin, TimeNs t_end) {
  constexpr std::size_t kSteps = scan::ScanMotion::kSteps;
  const DurationNs step{(t_end - t_begin).ns / static_cast<std::int64_t>(kSteps)};
  std::array<geom::Pose3, kSteps + 1> local_T_body;
  std::size_t next_step = 0;
  const auto record = [&](const InertialState& from, const InertialState& to) {
    while (next_step <= kSteps) {
      const TimeNs at =
          next_step == kSteps ? t_end : t_begin + DurationNs{step.ns * static_cast<std::int64_t>(next_step)};
      if (at > to.t) return;
      const double span = (to.t - from.t).Seconds();
      const double s = span > 0 ? (at - from.t).Seconds() / span : 1.0;  // < 0 for the part before the last scan's end
      const geom::Vec3d turn = geom::LogSo3((from.local_T_body.q.conjugate() * to.local_T_body.q).normalized());
      local_T_body[next_step].t = from.local_T_body.t + s * (to.local_T_body.t - from.local_T_body.t);
      local_T_body[next_step].q = from.local_T_body.q * geom::ExpSo3(s * turn);
      ++next_step;
    }
  };

  coasted_ = {};
  while (state_.t < t_end) {
    const InertialState before = state_;
    Step(t_end);
    record(before, state_);
  }
  for (; next_step <= kSteps; ++next_step) local_T_body[next_step] = state_.local_T_body;

  const geom::Pose3 end_T_local = state_.local_T_body.Inverse();
  for (std::size_t i = 0; i <= kSteps; ++i) motion_.end_T_body[i] = end_T_local * local_T_body[i];
}

// Second scan: which speed ahead or astern brings it onto the first? Both are smeared alike, so the shift between them
// is right although neither could be de-skewed. Standing still is believed unless another speed fits much better: a
// smooth road feels like rest to an IMU. Some 20 passes over the features, once.
void Lio::GuessSpeed() {
  constexpr double kGateM = 0.3;
  const double dt_s = (state_.t - scan_state_.t).Seconds();
  const geom::Vec3d ahead = state_.local_T_body.q * geom::Vec3d::UnitX();
  const auto inliers_at = [&](double speed_m_s) {
    geom::Pose3 shifted = scan_state_.local_T_body;
    shifted.t += speed_m_s * dt_s * ahead;
    shifted.q = state_.local_T_body.q;
    planes_.Find(features_, shifted, &map_);
    return MatchScan(features_, planes_, shifted, kGateM, config_.match).inliers;
  };
  int most = std::max(config_.min_inliers, inliers_at(0) * 5 / 4);
  double best_m_s = 0;
  for (int i = -3; i <= 17; ++i) {
    const int inliers = inliers_at(2.0 * i);
    if (inliers <= most) continue;
    most = inliers;
    best_m_s = 2.0 * i;
  }
  speed_unknown_ = best_m_s != 0;
  if (!speed_unknown_) return;
  state_.local_T_body.t = scan_state_.local_T_body.t + best_m_s * dt_s * ahead;
  state_.v_local = best_m_s * ahead;
  covariance_ = CovarianceInMotion();
}

// The speed has just become known: the scan is de-skewed again and the map starts from it, without the smeared first.
void Lio::BeginMapAgain(const sensor::Scan& scan) {
  const geom::Vec3d v_body = state_.local_T_body.q.conjugate() * state_.v_local;
  const double duration_s = (scan.t_end - scan.t_begin).Seconds();
  for (std::size_t i = 0; i <= scan::ScanMotion::kSteps; ++i) {
    const double before_end_s =
        duration_s * (1 - static_cast<double>(i) / static_cast<double>(scan::ScanMotion::kSteps));
    motion_.end_T_body[i] = {-before_end_s * v_body, geom::ExpSo3(-before_end_s * turn_body_)};
  }
  scan::Deskew(scan, motion_, config_.body_T_lidar, config_.deskew, &body_points_);
  map_.Clear();
  speed_unknown_ = false;
}

// Iterated update (FAST-LIO2, eqs. 14-18) in information form:
//   minimise |x - prediction|^2_P^-1 + sum of squared point-to-plane residuals.
void Lio::UpdateFromScan(LioUpdate* update) {
  const InertialState prediction = state_;
  const ErrorMatrix prior_information = covariance_.ldlt().solve(ErrorMatrix::Identity());
  const double sigma_m = std::sqrt(covariance_.block<3, 3>(kPosition, kPosition).trace());
  const double widen = std::clamp(2 * sigma_m / kFirstGateM[0], 1.0, 3.0);  // an uncertain prediction searches farther
  ErrorMatrix information = prior_information;
  InertialState estimate = prediction;
  for (int i = 0; i < config_.max_iterations; ++i) {
    const double gate = i < 3 ? widen * kFirstGateM[i] : 0.0;
    if (i == 0 || !planes_.HoldAt(estimate.local_T_body)) planes_.Find(features_, estimate.local_T_body, &map_);
    ScanMatch match = MatchScan(features_, planes_, estimate.local_T_body, gate, config_.match);
    update->iterations = i + 1;
    update->inliers = match.inliers;
    if (match.inliers < config_.min_inliers) return;
    update->residual_rms_m = std::sqrt(match.residual_sq_sum / match.inliers);
    update->degeneracy =
        RemoveOpenDirections(config_.degeneracy, match.normal_noise, &match.information, &match.gradient);

    information = prior_information;
    information.topLeftCorner<6, 6>() += match.information;
    ErrorVector gradient = prior_information * LocalCoordinates(prediction, estimate);
    gradient.head<6>() += match.gradient;
    const ErrorVector step = -information.ldlt().solve(gradient);
    if (!step.allFinite()) return;
    estimate = Retract(estimate, step);
    if (i >= 2 && step.head<3>().norm() < 1e-3 && step.segment<3>(kRotation).norm() < 1e-4) break;
  }
  const geom::Mat6d prior = covariance_.topLeftCorner<6, 6>();
  covariance_ = information.ldlt().solve(ErrorMatrix::Identity());
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  // The covariance of a correction is what the covariance of the state loses by it.
  const geom::Vec6d moved = LocalCoordinates(prediction, estimate).head<6>();
  const geom::Mat6d expected =
      prior - covariance_.topLeftCorner<6, 6>() + 1e-3 * geom::Mat6d(prior.diagonal().asDiagonal());
  update->surprise = moved.dot(expected.ldlt().solve(moved)) / 6;
  // Where no IMU measured, the scans tell the rate of turn.
  const double since_s = (prediction.t - scan_state_.t).Seconds();
  if (coasted_.Seconds() > 0.5 * since_s && since_s > 0) {
    turn_body_ =
        geom::LogSo3((scan_state_.local_T_body.q.conjugate() * estimate.local_T_body.q).normalized()) / since_s;
  }
  state_ = estimate;
  update->degenerate = update->degeneracy.any();
  update->corrected = true;
}

void Lio::GrowMap() {
  const Eigen::Matrix3f rotation = state_.local_T_body.q.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = state_.local_T_body.t.cast<float>();
  const float max_squared = config_.max_map_range_m * config_.max_map_range_m;
  for (const scan::BodyPoint& point : body_points_) {
    if (point.p.squaredNorm() > max_squared) continue;
    (void)map_.Insert(rotation * point.p + translation);  // out of the grid after 500 km: the map stays as it is
  }
  has_map_ = true;
}

void Lio::Publish(LioUpdate* update) {
  const geom::Quatd odom_R_local = geom::RotationBetween(-state_.gravity_local.normalized(), geom::Vec3d::UnitZ());
  odom_T_body_.t += odom_R_local * (state_.local_T_body.t - scan_state_.local_T_body.t);
  odom_T_body_.q = (odom_R_local * state_.local_T_body.q).normalized();
  scan_state_ = state_;
  update->odom_T_body = odom_T_body_;
  update->sigma_m = std::sqrt(covariance_.block<3, 3>(kPosition, kPosition).trace());
  update->covariance = covariance_.topLeftCorner<6, 6>();
}

}  // namespace mapweld::lio
