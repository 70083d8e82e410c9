// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/agent_pipeline.hpp"

namespace mapweld::pipeline {

AgentPipeline::AgentPipeline(const AgentConfig& config, AgentSink* sink)
    : config_(config), sink_(sink), lio_(config.lio), rolling_map_(config.submap), correction_(config.correction) {
  // Keyframes wait for release_distance_m of travel: the ring must hold them all.
  MAPWELD_ASSERT(config.release_distance_m / config.keyframe_spacing_m + 2 <
                 static_cast<double>(kCap.pending_keyframes));
}

void AgentPipeline::OnImu(const sensor::ImuSample& sample) {
  if (lio_.AddImu(sample) != Status::kOk) ++counters_.imu_refused;
  ProcessWaitingScan();
}

void AgentPipeline::OnPacket(const sensor::LidarPacket& packet) {
  // The IMU samples of a scan that still waits when the next one is complete will not come any more.
  const bool late = packet.t - waiting_scan_.t_end > config_.imu_patience;
  if (scan_waits_ && (late || accumulator_.Completes(packet))) {
    scan_waits_ = false;
    OnScan(waiting_scan_);
  }
  bool has_scan = false;
  if (accumulator_.Add(packet, &waiting_scan_, &has_scan) == Status::kStale) ++counters_.packets_stale;
  if (!has_scan) return;
  scan_waits_ = true;
  ProcessWaitingScan();
}

void AgentPipeline::OnDriveEnd() {
  if (scan_waits_) OnScan(waiting_scan_);
  scan_waits_ = false;
  if (accumulator_.Flush(&waiting_scan_)) OnScan(waiting_scan_);
  while (!pending_.empty()) ReleaseStep();
}

void AgentPipeline::ProcessWaitingScan() {
  if (!scan_waits_ || lio_.newest_imu() < waiting_scan_.t_end) return;
  scan_waits_ = false;
  OnScan(waiting_scan_);
}

void AgentPipeline::OnScan(const sensor::Scan& scan) {
  lio::LioUpdate update;
  if (lio_.AddScan(scan, &update) != Status::kOk) {
    ++counters_.scans_dropped;
    return;
  }
  ++counters_.scans;
  if (has_pose_) path_m_ += (update.odom_T_body.t - last_odom_T_body_.t).norm();
  last_odom_T_body_ = update.odom_T_body;
  has_pose_ = true;

  FeedSubmaps();
  TakeKeyframeIfDue(update);
  ReleaseDueKeyframes();

  PoseOutput pose{update, path_m_, correction_.group(), update.odom_T_body};
  if (correction_.active()) pose.merged_T_body = correction_.MergedFromOdom(update.t) * update.odom_T_body;
  sink_->OnPose(pose);
}

void AgentPipeline::FeedSubmaps() {
  const Eigen::Matrix3f rotation = last_odom_T_body_.q.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = last_odom_T_body_.t.cast<float>();
  const float max_squared = config_.submap_range_m * config_.submap_range_m;
  for (const scan::BodyPoint& point : lio_.body_points()) {
    if (point.p.squaredNorm() > max_squared) continue;
    (void)rolling_map_.Insert(rotation * point.p + translation, path_m_);  // out of the grid after 500 km: not mapped
  }
}

void AgentPipeline::TakeKeyframeIfDue(const lio::LioUpdate& update) {
  if (path_m_ < next_keyframe_path_m_) return;
  pending_.Push({next_keyframe_, update.t, update.odom_T_body, path_m_});
  correction_.AddKeyframe(next_keyframe_, update.odom_T_body);
  ++next_keyframe_;
  next_keyframe_path_m_ += config_.keyframe_spacing_m;
}

bool AgentPipeline::Due(std::size_t pending) const {
  return pending < pending_.size() && path_m_ - pending_[pending].path_m >= config_.release_distance_m;
}

void AgentPipeline::ReleaseDueKeyframes() {
  if (Due(0)) ReleaseStep();
  while (Due(1)) ReleaseStep();  // fast driving: more keyframes than steps
}

void AgentPipeline::ReleaseStep() {
  switch (release_stage_) {
    case ReleaseStage::kCut: {
      const PendingKeyframe& pending = pending_.front();
      release_ = {};
      release_.index = pending.index;
      release_.t = pending.t;
      release_.odom_T_body = pending.odom_T_body;
      release_.path_m = pending.path_m;
      release_.flushed = !Due(0);
      submap_.keyframe = pending.index;
      submap_.t = pending.t;
      submap_.flushed = release_.flushed;
      const Status cut = rolling_map_.Extract(pending.odom_T_body, pending.path_m, &submap_);
      if (cut != Status::kOk) ++counters_.submaps_truncated;
      release_.submap_points = submap_.points.size();
      release_stage_ = ReleaseStage::kDescribe;
      return;
    }
    case ReleaseStage::kDescribe:
      if (describer_.Describe(submap_, &release_.place) != Status::kOk) {
        ++counters_.undescribed;
        release_.place = {};
      }
      release_stage_ = ReleaseStage::kEncode;
      return;
    case ReleaseStage::kEncode: {
      const Result<std::size_t> bytes = encoder_.Encode(submap_, encoded_);
      if (bytes.ok()) release_.encoded = {encoded_.data(), bytes.value()};
      ++counters_.keyframes;
      pending_.PopFront();
      release_stage_ = ReleaseStage::kCut;
      sink_->OnKeyframe(release_);
      return;
    }
  }
}

}  // namespace mapweld::pipeline
