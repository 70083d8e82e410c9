// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/agent_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/place/describer.hpp"
#include "core/submap/rolling_map.hpp"
#include "core/submap/submap_codec.hpp"
#include "drivers/messages/channel.hpp"
#include "drivers/messages/codec.hpp"
#include "tools/sim/output_file.hpp"

namespace mapweld::sim {
namespace {

// As the agent does it (core/pipeline).
constexpr double kKeyframeSpacing_m = 5;
constexpr double kReleaseDistance_m = 100;
constexpr float kSubmapRange_m = 60;

class LcmLog {
 public:
  LcmLog(const std::filesystem::path& path, std::int16_t agent_id)
      : path_(path), file_(path.string(), "w"), agent_id_(agent_id) {
    if (!file_.good()) throw std::runtime_error(fmt::format("cannot write {}", path_.string()));
  }
  template <class Message>
  void Write(messages::Kind kind, TimeNs t, const Message& message) {
    std::array<std::uint8_t, 2048> bytes;
    const Result<std::size_t> n = messages::Encode(message, bytes);
    messages::ChannelBuffer name;
    const auto channel = messages::FormatChannel(&name, agent_id_, kind);
    if (!n.ok() || !channel.ok()) throw std::runtime_error("a simulated message is out of its range");
    lcm::LogEvent event;
    event.eventnum = events_++;
    event.timestamp = t.ns / 1000;
    event.channel = std::string(channel.value());
    event.datalen = static_cast<std::int32_t>(n.value());
    event.data = bytes.data();
    if (file_.writeEvent(&event) != 0) {
      throw std::runtime_error(fmt::format("cannot write {}: is the disk full?", path_.string()));
    }
  }

 private:
  std::filesystem::path path_;
  lcm::LogFile file_;
  std::int16_t agent_id_;
  std::int64_t events_ = 0;
};

class Publisher {
 public:
  Publisher(const AgentLogSpec& spec, const std::filesystem::path& path)
      : agent_id_(spec.agent_id), log_(path, spec.agent_id) {}

  struct Pending {
    std::int32_t index = 0;
    TimeNs t;
    geom::Pose3 odom_T_body;
    double path_m = 0;
  };
  void OnScan(TimeNs t, const geom::Pose3& odom_T_body, const std::vector<Eigen::Vector3f>& odom_points) {
    if (has_pose_) path_m_ += (odom_T_body.t - before_).norm();
    has_pose_ = true;
    before_ = odom_T_body.t;
    const Eigen::Vector3f here = odom_T_body.t.cast<float>();
    for (const Eigen::Vector3f& p : odom_points) {
      if ((p - here).squaredNorm() <= kSubmapRange_m * kSubmapRange_m) (void)map_->Insert(p, path_m_);
    }
    if (path_m_ >= next_keyframe_m_) {
      pending_.push_back({next_index_++, t, odom_T_body, path_m_});
      next_keyframe_m_ += kKeyframeSpacing_m;
    }
    while (!pending_.empty() && path_m_ - pending_.front().path_m >= kReleaseDistance_m) Release(t, false);
  }
  void OnEnd(TimeNs t) {
    while (!pending_.empty()) Release(t, true);
  }
  [[nodiscard]] const AgentLogCounts& counts() const { return counts_; }
  AgentLogCounts& counts() { return counts_; }

 private:
  void Release(TimeNs now, bool flushed) {
    const Pending pending = pending_.front();
    pending_.pop_front();
    submap_->keyframe = pending.index;
    submap_->t = pending.t;
    submap_->flushed = flushed;
    (void)map_->Extract(pending.odom_T_body, pending.path_m, submap_.get());  // kFull: cut off, as on the vehicle
    place::PlaceDescription place;
    if (describer_->Describe(*submap_, &place) != Status::kOk) place = {};
    std::vector<std::uint8_t> encoded(kCap.submap_encoded_bytes);
    const Result<std::size_t> bytes = encoder_->Encode(*submap_, encoded);
    encoded.resize(bytes.ok() ? bytes.value() : 0);
    WriteKeyframe(now, pending, flushed, place, encoded.size());
    WriteChunks(now, pending.index, encoded);
    ++counts_.keyframes;
    counts_.submap_bytes += static_cast<std::int64_t>(encoded.size());
  }

  void WriteKeyframe(TimeNs now, const Pending& pending, bool flushed, const place::PlaceDescription& place,
                     std::size_t encoded_bytes) {
    mapweldlcm::keyframe_t m{};
    m.agent_id = agent_id_;
    m.epoch = 1;
    m.index = pending.index;
    m.t_ns = pending.t.ns;
    const geom::Vec3d& t = pending.odom_T_body.t;
    const geom::Quatd& q = pending.odom_T_body.q;
    std::copy_n(t.data(), 3, m.odom_t_body);
    std::copy_n(q.coeffs().data(), 4, m.odom_q_body);  // x, y, z, w
    m.path_m = static_cast<float>(pending.path_m);
    m.flushed = flushed ? 1 : 0;
    m.submap_points = static_cast<std::int32_t>(submap_->points.size());
    m.submap_bytes = static_cast<std::int32_t>(encoded_bytes);
    m.descriptor_scale = place.descriptor.scale;
    std::copy(place.descriptor.q.begin(), place.descriptor.q.end(), m.descriptor);
    m.orientation_scale = place.orientation.scale;
    std::copy(place.orientation.q.begin(), place.orientation.q.end(), m.orientation);
    log_.Write(messages::Kind::kKeyframe, now, m);
  }

  void WriteChunks(TimeNs now, std::int32_t index, const std::vector<std::uint8_t>& encoded) {
    mapweldlcm::submap_chunk_t m{};
    m.agent_id = agent_id_;
    m.epoch = 1;
    m.keyframe = index;
    m.total_bytes = static_cast<std::int32_t>(encoded.size());
    for (std::size_t offset = 0; offset < encoded.size(); offset += sizeof(m.data)) {
      const std::size_t n = std::min(sizeof(m.data), encoded.size() - offset);
      m.offset = static_cast<std::int32_t>(offset);
      m.n = static_cast<std::int16_t>(n);
      std::copy_n(encoded.data() + offset, n, m.data);
      log_.Write(messages::Kind::kSubmapChunk, now, m);
    }
  }

  std::int16_t agent_id_;
  LcmLog log_;
  AgentLogCounts counts_;
  bool has_pose_ = false;
  geom::Vec3d before_;
  double path_m_ = 0;
  double next_keyframe_m_ = 0;
  std::int32_t next_index_ = 0;
  std::deque<Pending> pending_;
  std::unique_ptr<submap::RollingMap> map_ = std::make_unique<submap::RollingMap>();
  std::unique_ptr<submap::Submap> submap_ = std::make_unique<submap::Submap>();
  std::unique_ptr<submap::SubmapEncoder> encoder_ = std::make_unique<submap::SubmapEncoder>();
  std::unique_ptr<place::Describer> describer_ = std::make_unique<place::Describer>();
};

}  // namespace

AgentLogCounts WriteAgentLog(const RayCaster& caster, const VehicleMotion& motion, const Traffic* traffic,
                             const AgentLogSpec& spec, const std::filesystem::path& log,
                             const std::filesystem::path& truth, const std::function<void(double)>& progress) {
  const LidarSimulator lidar(caster, motion, traffic, spec.lidar, spec.weather, spec.start_past_hour_ns, spec.seed);
  DriftingOdometry odometry(spec.odometry, spec.seed);
  Publisher publisher(spec, log);
  OutputFile truth_file(truth);
  std::vector<Eigen::Vector3f> points;
  geom::Pose3 last_scan;
  TimeNs now{spec.start_past_hour_ns};
  const auto revolutions = static_cast<std::int64_t>(spec.duration_s * 1e9) / kRevolution_ns;
  for (std::int64_t i = 0; i < revolutions; ++i) {
    const geom::Pose3 world_T_body = motion.WorldFromBody(static_cast<double>(i * kRevolution_ns) * 1e-9);
    if (i > 0 && (world_T_body.t - last_scan.t).norm() < spec.scan_spacing_m) continue;
    last_scan = world_T_body;
    now = {spec.start_past_hour_ns + i * kRevolution_ns};
    const geom::Pose3 odom_T_body = odometry.Next(world_T_body);
    points.clear();
    const std::int64_t first = i * kRevolution_ns * 1000 / spec.lidar.column_ps;
    for (std::int64_t c = first; c < first + lidar.ColumnsPerRevolution(); ++c) lidar.AppendPoints(c, &points);
    const geom::Pose3 odom_T_world = odom_T_body * world_T_body.Inverse();
    for (Eigen::Vector3f& p : points) p = (odom_T_world * geom::Vec3d(p.cast<double>())).cast<float>();
    publisher.OnScan(now, odom_T_body, points);
    const geom::Vec3d& t = world_T_body.t;
    const geom::Quatd& q = world_T_body.q;
    truth_file.Write(fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n",
                                 static_cast<double>(now.ns) * 1e-9, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()));
    ++publisher.counts().scans;
    if (i % 64 == 0) progress(static_cast<double>(i) / static_cast<double>(revolutions));
  }
  publisher.OnEnd(now);
  truth_file.Close();
  progress(1);
  return publisher.counts();
}

}  // namespace mapweld::sim
