// SPDX-License-Identifier: Apache-2.0
// What happens on the vehicle, in one place: samples and packets in, poses and keyframes out.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/fixed_vector.hpp"
#include "core/base/ring_buffer.hpp"
#include "core/correct/local_correction.hpp"
#include "core/lio/lio.hpp"
#include "core/place/describer.hpp"
#include "core/scan/scan_accumulator.hpp"
#include "core/sensor/imu_sample.hpp"
#include "core/sensor/lidar_packet.hpp"
#include "core/submap/rolling_map.hpp"
#include "core/submap/submap.hpp"
#include "core/submap/submap_codec.hpp"

namespace mapweld::pipeline {

// Keyframes wait for the release distance: the ring must hold them all.
constexpr bool PendingKeyframesFit(double release_distance_m, double spacing_m) {
  return release_distance_m / spacing_m + 2 < static_cast<double>(kCap.pending_keyframes);
}

struct AgentConfig {
  static constexpr double kSpacing_m = 5.0;
  static constexpr double kReleaseDistance_m = 100.0;
  static_assert(PendingKeyframesFit(kReleaseDistance_m, kSpacing_m));

  lio::LioConfig lio;
  submap::RollingMapConfig submap;
  correct::LocalCorrectionConfig correction;
  double keyframe_spacing_m = kSpacing_m;
  double release_distance_m =
      kReleaseDistance_m;        // travel past a keyframe before its submap is cut, so that both directions agree
  float submap_range_m = 60.0F;  // points farther from the vehicle do not enter submaps
  DurationNs imu_patience =
      Milliseconds(200);  // of LiDAR time: how long a scan waits for the IMU samples that cover it
};

// Smaller submaps, sooner: rooms and corridors end nearer than streets.
void UseIndoors(AgentConfig* config);

// Once per revolution, before the submaps see it.
struct PoseOutput {
  lio::LioUpdate odometry;
  double path_m = 0;
  std::int32_t group = -1;  // of the merged frame; -1: not merged, merged_T_body equals odom_T_body
  geom::Pose3 merged_T_body;
};

// Once per released keyframe. `encoded` is valid during the call only. A place description with scale 0 says that the
// submap was unfit to be described.
struct KeyframeOutput {
  std::int32_t index = 0;
  TimeNs t;
  geom::Pose3 odom_T_body;
  double path_m = 0;
  bool flushed = false;
  std::size_t submap_points = 0;
  place::PlaceDescription place;
  std::span<const std::uint8_t> encoded;
};

// The receiver of results; called from within the On... functions.
class AgentSink {
 public:
  virtual void OnPose(const PoseOutput& pose) = 0;
  virtual void OnKeyframe(const KeyframeOutput& keyframe) = 0;

 protected:
  ~AgentSink() = default;
};

struct AgentCounters {
  std::uint64_t scans = 0;
  std::uint64_t scans_dropped = 0;  // not aligned yet, no points, out of order
  std::uint64_t packets_stale = 0;
  std::uint64_t imu_refused = 0;  // out of order or not finite
  std::uint64_t keyframes = 0;
  std::uint64_t undescribed = 0;        // keyframes whose submap was unfit
  std::uint64_t submaps_truncated = 0;  // more points than capacity
};

// Same inputs in the same order, same outputs. Some 25 MB: static memory only. One thread.
class AgentPipeline {
 public:
  AgentPipeline(const AgentConfig& config, AgentSink* sink);

  void OnImu(const sensor::ImuSample& sample);
  void OnPacket(const sensor::LidarPacket& packet);
  // The drive is over: the last scan is processed and all pending keyframes are released, marked as flushed.
  void OnDriveEnd();
  Status OnMergedPose(const correct::MergedPose& pose) { return correction_.AddMergedPose(pose); }

  [[nodiscard]] bool aligned() const { return lio_.aligned(); }
  [[nodiscard]] double path_m() const { return path_m_; }
  [[nodiscard]] const AgentCounters& counters() const { return counters_; }

 private:
  struct PendingKeyframe {
    std::int32_t index = 0;
    TimeNs t;
    geom::Pose3 odom_T_body;
    double path_m = 0;
  };

  void ProcessWaitingScan();
  void OnScan(const sensor::Scan& scan);
  void FeedSubmaps(const sensor::Scan& scan);
  void TakeKeyframeIfDue(const lio::LioUpdate& update);
  [[nodiscard]] bool Due(std::size_t pending) const;
  void ReleaseDueKeyframes(double step_m);
  double ReleaseStep();  // gives its share of the work for one keyframe

  AgentConfig config_;
  AgentSink* sink_;
  AgentCounters counters_;

  scan::ScanAccumulator accumulator_;
  sensor::Scan waiting_scan_;
  bool scan_waits_ = false;

  lio::Lio lio_;
  bool has_pose_ = false;
  geom::Pose3 last_odom_T_body_;
  double path_m_ = 0;

  // The oldest pending keyframe on its way out, in small steps.
  enum class ReleaseStage { kBegin, kCut, kDescribe, kEncode };

  submap::RangeImage range_image_;
  submap::RollingMap rolling_map_;
  RingBuffer<PendingKeyframe, kCap.pending_keyframes> pending_;
  std::int32_t next_keyframe_ = 0;
  double next_keyframe_path_m_ = 0;

  ReleaseStage release_stage_ = ReleaseStage::kBegin;
  double release_credit_ = 0;  // steps paid for by travel, as a share of the work for one keyframe
  std::size_t cut_steps_ = 0;
  bool encodable_ = false;
  KeyframeOutput release_;
  place::Describer describer_;
  submap::Submap submap_;
  submap::SubmapEncoder encoder_;
  std::array<std::uint8_t, kCap.submap_encoded_bytes> encoded_{};

  correct::LocalCorrection correction_;
};

}  // namespace mapweld::pipeline
