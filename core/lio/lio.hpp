// SPDX-License-Identifier: Apache-2.0
// LiDAR-inertial odometry: an iterated error-state Kalman filter on a fixed-memory voxel map. The scheme is that of
// FAST-LIO2 (Xu et al., T-RO 2022, section IV) with the update in information form, so its cost does not grow with the
// number of points.
#pragma once

#include "core/base/ring_buffer.hpp"
#include "core/base/status.hpp"
#include "core/lio/degeneracy.hpp"
#include "core/lio/imu_alignment.hpp"
#include "core/lio/inertial_state.hpp"
#include "core/lio/scan_match.hpp"
#include "core/lio/voxel_map.hpp"
#include "core/scan/deskew.hpp"
#include "core/scan/voxel_downsample.hpp"
#include "core/sensor/scan.hpp"

namespace mapweld::lio {

struct LioConfig {
  bool use_imu = true;  // false: constant velocity between scans, for recordings without an IMU; z is up at the start
  geom::Pose3 body_T_lidar{{0.10, 0.0, 0.35}, geom::Quatd::Identity()};
  ImuAlignmentConfig alignment;
  ImuNoise imu_noise;
  scan::DeskewConfig deskew;
  VoxelMapConfig map;
  ScanMatchConfig match;
  float feature_voxel_m = 0.6F;  // features for matching
  int max_iterations = 5;
  double max_imu_gap_s = 0.03;     // a longer gap between samples is coasted over
  float max_map_range_m = 80.0F;   // points farther away do not enter the map
  int min_inliers = 60;            // fewer: the scan does not correct the state
  int max_uncorrected_scans = 10;  // after that many the map is continued from the prediction
  DegeneracyConfig degeneracy;
};

// What one scan did to the estimate, with the evidence.
struct LioUpdate {
  TimeNs t;  // end of the scan
  geom::Pose3 odom_T_body;
  int features = 0;
  int inliers = 0;
  int iterations = 0;
  double residual_rms_m = 0;
  Degeneracy degeneracy;    // of the position and the rotation, with the numbers
  bool degenerate = false;  // the scan leaves a direction open; the IMU carries it
  bool corrected = false;   // false: too few inliers, prediction only
  double surprise = 0;      // squared correction over its expected size: 0.02 on clean drives, above 1 when models lie
  double sigma_m = 0;       // standard deviation of the position
  geom::Mat6d covariance = geom::Mat6d::Zero();  // of the pose against the map: m in local axes, then rad in the body
};

// Owns its map and scratch (see sizeof); no heap. One thread.
//
// The filter lives in `local`, the frame of its map. Published poses are in `odom`: the same motion, each step turned
// upright by what is known of gravity at that time. So roll and pitch in odom are true to gravity although the map was
// begun with the accelerometer's offset in its "down", and odom never jumps.
class Lio {
 public:
  explicit Lio(const LioConfig& config = {}) : config_(config), alignment_(config.alignment), map_(config.map) {}

  // Samples in time order. kStale: not newer than the last one; after kResyncSamples of these in a row the newcomers
  // are believed: the stamp before them had jumped ahead. kBadInput: not finite, clipped, or the sensor has been
  // repeating itself for kStuckSamples. Both leave the state as it was; what is missing then is coasted over.
  Status AddImu(const sensor::ImuSample& sample);

  // Runs one scan through the filter. IMU samples up to scan.t_end should have been added: what is missing is coasted
  // over with the last known velocity and rate of turn.
  // kNotReady: still aligning. kBadInput: no points or no duration. kStale: ends before the last scan's end.
  Status AddScan(const sensor::Scan& scan, LioUpdate* update);

  [[nodiscard]] bool aligned() const { return aligned_; }
  [[nodiscard]] TimeNs newest_imu() const { return newest_imu_; }
  [[nodiscard]] const InertialState& state() const { return state_; }
  // The last scan's de-skewed points in the body frame at its end.
  [[nodiscard]] const scan::BodyPoints& body_points() const { return body_points_; }
  // How the body moved during that scan, as predicted.
  [[nodiscard]] const scan::ScanMotion& scan_motion() const { return motion_; }

 private:
  void StartFromAlignment(TimeNs t);
  void StartWithoutImu(TimeNs t);
  [[nodiscard]] bool Measured() const;
  void Step(TimeNs t_end);
  void PredictTo(TimeNs t_begin, TimeNs t_end);
  static constexpr int kResyncSamples = 20;
  static constexpr int kStuckSamples = 20;  // a live sensor's noise does not give the same six numbers so often

  [[nodiscard]] bool IsStuck(const sensor::ImuSample& sample);
  void GuessSpeed();
  void BeginMapAgain(const sensor::Scan& scan);
  void UpdateFromScan(LioUpdate* update);
  void GrowMap();
  void Publish(LioUpdate* update);

  LioConfig config_;
  ImuAlignment alignment_;
  VoxelMap map_;
  bool aligned_ = false;
  bool has_map_ = false;
  bool speed_unknown_ = false;  // until the second scan
  int uncorrected_scans_ = 0;
  InertialState state_;
  geom::Vec3d turn_body_ = geom::Vec3d::Zero();  // rad/s, the last known
  DurationNs coasted_;                           // of the present prediction
  InertialState scan_state_;                     // at the end of the last scan, ...
  geom::Pose3 odom_T_body_;                      // ... and the pose published for it
  ErrorMatrix covariance_ = ErrorMatrix::Zero();
  TimeNs newest_imu_{INT64_MIN};
  sensor::ImuSample last_imu_;
  int repeats_ = 0;
  int stale_in_a_row_ = 0;
  RingBuffer<sensor::ImuSample, kCap.imu_ring> imu_;
  scan::ScanMotion motion_;
  scan::BodyPoints body_points_;
  scan::VoxelDownsample downsample_;
  scan::FeaturePoints features_;
  FeaturePlanes planes_;
};

}  // namespace mapweld::lio
