// SPDX-License-Identifier: Apache-2.0
// Where the vehicle is in the merged map: the odometry of its last keyframes and the merged poses that came back for
// them, brought together in a small sliding window.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/fixed_vector.hpp"
#include "core/base/status.hpp"
#include "core/base/time.hpp"
#include "core/config/capacity.hpp"
#include "core/geom/pose3.hpp"

namespace mapweld::correct {

struct LocalCorrectionConfig {
  double odometry_sigma_m = 0.05;  // per keyframe step
  double odometry_sigma_rad = 0.002;
  double robust_sigma = 3.0;  // Huber threshold of the merged poses, in their own sigmas
  int iterations = 5;
  double slew_m_per_s = 1.0;  // how fast the published correction may move ...
  double slew_rad_per_s = 0.05;
};

// The merged pose of one keyframe, as the host sent it.
struct MergedPose {
  std::int32_t keyframe = 0;
  std::int32_t group = -1;
  std::int32_t revision = 0;
  geom::Pose3 merged_T_body;
  double sigma_m = 0.1;
  double sigma_rad = 0.01;
};

// Gauss-Newton over at most kCap.correction_window poses: a block-tridiagonal system solved by forward elimination, so
// the cost is window * 6^3 per iteration. About 40 kB. No heap.
class LocalCorrection {
 public:
  explicit LocalCorrection(const LocalCorrectionConfig& config = {}) : config_(config) {}

  // The agent's own keyframes, in order, as they are taken.
  void AddKeyframe(std::int32_t keyframe, const geom::Pose3& odom_T_body);
  // kOutOfRange: a keyframe that is unknown or too old. kStale: an older revision. kBadInput: not a pose.
  // A pose of another group starts over: the vehicle now belongs to another map.
  Status AddMergedPose(const MergedPose& pose);

  [[nodiscard]] bool active() const { return group_ >= 0; }
  [[nodiscard]] std::int32_t group() const { return group_; }
  // Merged from odom at time t, moved towards the newest solution no faster than the slew rates; at the first solution,
  // and when the group changes, it jumps. Call with rising t.
  geom::Pose3 MergedFromOdom(TimeNs t);

 private:
  struct Entry {
    std::int32_t keyframe = -1;
    geom::Pose3 odom_T_body;
    bool has_merged = false;
    MergedPose merged;
  };
  static constexpr std::size_t kHistory = 256;  // keyframes remembered, 1.28 km

  Entry* Find(std::int32_t keyframe);
  void Solve();

  LocalCorrectionConfig config_;
  std::int32_t group_ = -1;
  std::int32_t revision_ = -1;
  bool jump_ = true;
  TimeNs last_t_;
  geom::Pose3 target_;     // merged_T_odom of the newest solution
  geom::Pose3 published_;  // merged_T_odom as given out
  std::array<Entry, kHistory> history_{};
};

}  // namespace mapweld::correct
