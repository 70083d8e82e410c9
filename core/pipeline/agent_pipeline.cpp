// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/agent_pipeline.hpp"

namespace mapweld::pipeline {
namespace {

// What the steps of a release cost, as shares of the whole.
constexpr double kCutShare = 0.3 / submap::RollingMap::kCutSteps;
constexpr double kDescribeShare = 0.2;
constexpr std::size_t kEncodePoints = 4096;
double EncodeShare(std::size_t points) {
  return 0.5 / static_cast<double>(points / kEncodePoints + 1);
}

}  // namespace

void UseIndoors(AgentConfig* config) {
  config->submap.radius_m = 20.0F;
  config->submap.reach_m = 60.0;
  config->submap_range_m = 25.0F;
  config->release_distance_m = 40.0;
}

AgentPipeline::AgentPipeline(const AgentConfig& config, AgentSink* sink)
    : config_(config), sink_(sink), lio_(config.lio), rolling_map_(config.submap), correction_(config.correction) {
  MAPWELD_ASSERT(PendingKeyframesFit(config.release_distance_m, config.keyframe_spacing_m));
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
  while (!pending_.empty()) (void)ReleaseStep();
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
  const double step_m = has_pose_ ? (update.odom_T_body.t - last_odom_T_body_.t).norm() : 0;
  path_m_ += step_m;
  last_odom_T_body_ = update.odom_T_body;
  has_pose_ = true;

  PoseOutput pose{update, path_m_, correction_.group(), update.odom_T_body};
  if (correction_.active()) pose.merged_T_body = correction_.MergedFromOdom(update.t) * update.odom_T_body;
  sink_->OnPose(pose);

  FeedSubmaps(scan);
  TakeKeyframeIfDue(update);
  ReleaseDueKeyframes(step_m);
}

void AgentPipeline::FeedSubmaps(const sensor::Scan& scan) {
  const Eigen::Matrix3f rotation = last_odom_T_body_.q.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = last_odom_T_body_.t.cast<float>();
  const float max_squared = config_.submap_range_m * config_.submap_range_m;
  for (const scan::BodyPoint& point : lio_.body_points()) {
    if (point.p.squaredNorm() > max_squared) continue;
    (void)rolling_map_.Insert(rotation * point.p + translation, path_m_);  // out of the grid after 500 km: not mapped
  }
  std::array<geom::Pose3, submap::RangeImage::kPoses> odom_T_lidar;
  for (std::size_t i = 0; i < odom_T_lidar.size(); ++i) {
    odom_T_lidar[i] = last_odom_T_body_ * lio_.scan_motion().end_T_body[i] * config_.lio.body_T_lidar;
  }
  range_image_.Build(scan, odom_T_lidar);
  rolling_map_.Vote(range_image_, translation, path_m_);
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

// The work for one keyframe goes along with the way to the next, so that every scan pays for its own stretch of path.
void AgentPipeline::ReleaseDueKeyframes(double step_m) {
  release_credit_ += Due(0) ? step_m / config_.keyframe_spacing_m : -release_credit_;
  while (Due(0) && (release_credit_ > 0 || Due(1))) release_credit_ -= ReleaseStep();
}

double AgentPipeline::ReleaseStep() {
  switch (release_stage_) {
    case ReleaseStage::kBegin: {
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
      rolling_map_.BeginCut(pending.odom_T_body, pending.path_m, &submap_);
      cut_steps_ = 0;
      release_stage_ = ReleaseStage::kCut;
      return 0;
    }
    case ReleaseStage::kCut: {
      const Status cut = rolling_map_.CutStep(&submap_);
      if (++cut_steps_ < submap::RollingMap::kCutSteps) return kCutShare;
      if (cut != Status::kOk) ++counters_.submaps_truncated;
      release_.submap_points = submap_.points.size();
      release_stage_ = ReleaseStage::kDescribe;
      return kCutShare;
    }
    case ReleaseStage::kDescribe:
      if (describer_.Describe(submap_, &release_.place) != Status::kOk) {
        ++counters_.undescribed;
        release_.place = {};
      }
      release_stage_ = ReleaseStage::kEncode;
      encodable_ = encoder_.Begin(submap_, encoded_) == Status::kOk;
      return kDescribeShare;
    case ReleaseStage::kEncode: {
      if (encodable_) {
        const Result<std::size_t> bytes = encoder_.Continue(submap_, kEncodePoints);
        if (bytes.status() == Status::kNotReady) return EncodeShare(submap_.points.size());
        if (bytes.ok()) release_.encoded = {encoded_.data(), bytes.value()};
      }
      ++counters_.keyframes;
      pending_.PopFront();
      release_stage_ = ReleaseStage::kBegin;
      sink_->OnKeyframe(release_);
      return EncodeShare(submap_.points.size());
    }
  }
  return 0;
}

}  // namespace mapweld::pipeline
