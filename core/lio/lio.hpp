// SPDX-License-Identifier: Apache-2.0
// LiDAR-inertial odometry: an iterated error-state Kalman filter on a fixed-memory voxel map. The scheme is that of
// FAST-LIO2 (Xu et al., T-RO 2022, section IV) with the update in information form, so its cost does not grow with the
// number of points.
#pragma once

#include "core/base/ring_buffer.hpp"
#include "core/base/status.hpp"
#include "core/lio/imu_alignment.hpp"
#include "core/lio/inertial_state.hpp"
#include "core/lio/scan_match.hpp"
#include "core/lio/voxel_map.hpp"
#include "core/scan/deskew.hpp"
#include "core/scan/voxel_downsample.hpp"
#include "core/sensor/scan.hpp"

namespace mapweld::lio {

struct LioConfig {
  geom::Pose3 body_T_lidar{{0.10, 0.0, 0.35}, geom::Quatd::Identity()};
  ImuAlignmentConfig alignment;
  ImuNoise imu_noise;
  scan::DeskewConfig deskew;
  VoxelMapConfig map;
  ScanMatchConfig match;
  float feature_voxel_m = 0.6F;  // features for matching
  int max_iterations = 5;
  double max_imu_gap_s = 0.03;            // a longer gap between samples is coasted over
  float max_map_range_m = 80.0F;          // points farther away do not enter the map
  int min_inliers = 60;                   // fewer: the scan does not correct the state
  int max_uncorrected_scans = 10;         // after that many the map is continued from the prediction
  double degenerate_information = 2.0e3;  // 1/m^2 along the worst direction: below it the scan does not fix a position
};

// What one scan did to the estimate, with the evidence.
struct LioUpdate {
  TimeNs t;  // end of the scan
  geom::Pose3 odom_T_body;
  int features = 0;
  int inliers = 0;
  int iterations = 0;
  double residual_rms_m = 0;
  double min_information = 0;  // smallest eigenvalue of the position block, 1/m^2
  bool degenerate = false;     // the scan leaves a direction open; the IMU carries it
  bool corrected = false;      // false: too few inliers, prediction only
  double sigma_m = 0;          // standard deviation of the position
};

// Owns its map and scratch (see sizeof); no heap. One thread.
class Lio {
 public:
  explicit Lio(const LioConfig& config = {}) : config_(config), alignment_(config.alignment), map_(config.map) {}

  // Samples in time order. kStale: not newer than the last one. kBadInput: not finite. Both leave the state as it was.
  Status AddImu(const sensor::ImuSample& sample);

  // Runs one scan through the filter. IMU samples up to scan.t_end should have been added: what is missing is coasted.
  // kNotReady: still aligning. kBadInput: no points or no duration. kStale: ends before the last scan's end.
  Status AddScan(const sensor::Scan& scan, LioUpdate* update);

  [[nodiscard]] bool aligned() const { return aligned_; }
  [[nodiscard]] TimeNs newest_imu() const { return newest_imu_; }
  [[nodiscard]] const InertialState& state() const { return state_; }
  // The last scan's de-skewed points in the body frame at its end.
  [[nodiscard]] const scan::BodyPoints& body_points() const { return body_points_; }

 private:
  void PredictTo(TimeNs t_begin, TimeNs t_end, scan::ScanMotion* motion);
  void UpdateFromScan(LioUpdate* update);
  void GrowMap();

  LioConfig config_;
  ImuAlignment alignment_;
  VoxelMap map_;
  bool aligned_ = false;
  bool has_map_ = false;
  int uncorrected_scans_ = 0;
  double gravity_m_s2_ = 9.81;
  InertialState state_;
  ErrorMatrix covariance_ = ErrorMatrix::Zero();
  TimeNs newest_imu_{INT64_MIN};
  RingBuffer<sensor::ImuSample, kCap.imu_ring> imu_;
  scan::BodyPoints body_points_;
  scan::VoxelDownsample downsample_;
  scan::FeaturePoints features_;
};

}  // namespace mapweld::lio
