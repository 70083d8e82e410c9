// SPDX-License-Identifier: Apache-2.0
#include "core/lio/lio.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace mapweld::lio {
namespace {

constexpr double kFirstGateM[] = {0.6, 0.4, 0.25};  // correspondence gate of the first iterations

ErrorMatrix InitialCovariance() {
  ErrorVector sigma;
  sigma.segment<3>(kPosition).setConstant(1e-4);  // odom starts here by definition
  sigma.segment<3>(kRotation).setConstant(5e-3);
  sigma.segment<3>(kVelocity).setConstant(1e-2);
  sigma.segment<3>(kGyroBias).setConstant(2e-3);
  sigma.segment<3>(kAccelBias).setConstant(3e-2);
  return sigma.cwiseProduct(sigma).asDiagonal();
}

}  // namespace

Status Lio::AddImu(const sensor::ImuSample& sample) {
  if (!sample.gyro_body.allFinite() || !sample.accel_body.allFinite()) return Status::kBadInput;
  if (sample.t <= newest_imu_) return Status::kStale;
  newest_imu_ = sample.t;
  if (aligned_) {
    imu_.Push(sample);
    return Status::kOk;
  }
  const Status status = alignment_.Add(sample);
  if (status != Status::kOk) return status == Status::kNotReady ? Status::kOk : status;
  aligned_ = true;
  gravity_m_s2_ = alignment_.alignment().gravity_m_s2;
  state_.t = sample.t;
  state_.odom_T_body.q = alignment_.alignment().odom_R_body;
  state_.gyro_bias = alignment_.alignment().gyro_bias;
  covariance_ = InitialCovariance();
  imu_.Push(sample);
  return Status::kOk;
}

Status Lio::AddScan(const sensor::Scan& scan, LioUpdate* update) {
  if (!aligned_) return Status::kNotReady;
  if (scan.points.empty() || scan.t_end <= scan.t_begin) return Status::kBadInput;
  if (scan.t_end <= state_.t) return Status::kStale;

  scan::ScanMotion motion;
  PredictTo(scan.t_begin, scan.t_end, &motion);
  scan::Deskew(scan, motion, config_.body_T_lidar, config_.deskew, &body_points_);
  downsample_.Run(body_points_, config_.feature_voxel_m, &features_);

  *update = LioUpdate{};
  update->t = scan.t_end;
  update->features = static_cast<int>(features_.size());
  map_.BeginScan();
  if (has_map_) UpdateFromScan(update);
  uncorrected_scans_ = update->corrected || !has_map_ ? 0 : uncorrected_scans_ + 1;
  if (uncorrected_scans_ == 0 || uncorrected_scans_ > config_.max_uncorrected_scans) GrowMap();
  update->odom_T_body = state_.odom_T_body;
  update->sigma_m = std::sqrt(covariance_.block<3, 3>(kPosition, kPosition).trace());
  return Status::kOk;
}

// Carries the state to t_end through the IMU samples and records the body's motion over [t_begin, t_end] for
// de-skewing.
void Lio::PredictTo(TimeNs t_begin, TimeNs t_end, scan::ScanMotion* motion) {
  constexpr std::size_t kSteps = scan::ScanMotion::kSteps;
  const DurationNs step{(t_end - t_begin).ns / static_cast<std::int64_t>(kSteps)};
  std::array<geom::Pose3, kSteps + 1> odom_T_body;
  std::size_t next_step = 0;
  const auto record = [&](const InertialState& from, const InertialState& to) {
    while (next_step <= kSteps) {
      const TimeNs at =
          next_step == kSteps ? t_end : t_begin + DurationNs{step.ns * static_cast<std::int64_t>(next_step)};
      if (at > to.t) return;
      const double span = (to.t - from.t).Seconds();
      const double s = span > 0 ? (at - from.t).Seconds() / span : 1.0;  // < 0 for the part before the last scan's end
      const geom::Vec3d turn = geom::LogSo3((from.odom_T_body.q.conjugate() * to.odom_T_body.q).normalized());
      odom_T_body[next_step].t = from.odom_T_body.t + s * (to.odom_T_body.t - from.odom_T_body.t);
      odom_T_body[next_step].q = from.odom_T_body.q * geom::ExpSo3(s * turn);
      ++next_step;
    }
  };

  while (state_.t < t_end) {
    while (imu_.size() > 1 && imu_[1].t <= state_.t) imu_.PopFront();  // imu_[0] is now the last at or before the state
    const bool bracketed = imu_.size() > 1 && imu_[0].t <= state_.t;
    const TimeNs until = std::min(bracketed ? imu_[1].t : t_end, t_end);
    const InertialState before = state_;
    const double dt = (until - state_.t).Seconds();
    if (bracketed && (imu_[1].t - imu_[0].t).Seconds() <= config_.max_imu_gap_s) {
      const geom::Vec3d gyro = 0.5 * (imu_[0].gyro_body + imu_[1].gyro_body);
      const geom::Vec3d accel = 0.5 * (imu_[0].accel_body + imu_[1].accel_body);
      Propagate(gyro, accel, dt, gravity_m_s2_, config_.imu_noise, &state_, &covariance_);
    } else {
      Coast(dt, &state_, &covariance_);
    }
    state_.t = until;  // exact, whatever the rounding of dt
    record(before, state_);
  }
  for (; next_step <= kSteps; ++next_step) odom_T_body[next_step] = state_.odom_T_body;

  const geom::Pose3 end_T_odom = state_.odom_T_body.Inverse();
  for (std::size_t i = 0; i <= kSteps; ++i) motion->end_T_body[i] = end_T_odom * odom_T_body[i];
}

// Iterated update (FAST-LIO2, eqs. 14-18) in information form:
//   minimise |x - prediction|^2_P^-1 + sum of squared point-to-plane residuals.
void Lio::UpdateFromScan(LioUpdate* update) {
  const InertialState prediction = state_;
  const ErrorMatrix prior_information = covariance_.ldlt().solve(ErrorMatrix::Identity());
  ErrorMatrix information = prior_information;
  InertialState estimate = prediction;
  for (int i = 0; i < config_.max_iterations; ++i) {
    const double gate = i < 3 ? kFirstGateM[i] : 0.0;
    const ScanMatch match = MatchScan(features_, estimate.odom_T_body, gate, config_.match, &map_);
    update->iterations = i + 1;
    update->inliers = match.inliers;
    if (match.inliers < config_.min_inliers) return;
    update->residual_rms_m = std::sqrt(match.residual_sq_sum / match.inliers);

    information = prior_information;
    information.topLeftCorner<6, 6>() += match.information;
    ErrorVector gradient = prior_information * LocalCoordinates(prediction, estimate);
    gradient.head<6>() += match.gradient;
    const ErrorVector step = -information.ldlt().solve(gradient);
    if (!step.allFinite()) return;
    estimate = Retract(estimate, step);

    const Eigen::SelfAdjointEigenSolver<geom::Mat3d> solver(match.information.topLeftCorner<3, 3>(),
                                                            Eigen::EigenvaluesOnly);
    update->min_information = solver.eigenvalues()(0);
    if (i >= 2 && step.head<3>().norm() < 1e-3 && step.segment<3>(kRotation).norm() < 1e-4) break;
  }
  state_ = estimate;
  covariance_ = information.ldlt().solve(ErrorMatrix::Identity());
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  update->degenerate = update->min_information < config_.degenerate_information;
  update->corrected = true;
}

void Lio::GrowMap() {
  const Eigen::Matrix3f rotation = state_.odom_T_body.q.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = state_.odom_T_body.t.cast<float>();
  const float max_squared = config_.max_map_range_m * config_.max_map_range_m;
  for (const scan::BodyPoint& point : body_points_) {
    if (point.p.squaredNorm() > max_squared) continue;
    (void)map_.Insert(rotation * point.p + translation);  // out of the grid after 500 km: the map stays as it is
  }
  has_map_ = true;
}

}  // namespace mapweld::lio
