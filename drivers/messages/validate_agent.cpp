// SPDX-License-Identifier: Apache-2.0
// Messages that agents send.
#include <algorithm>
#include <iterator>

#include "core/config/capacity.hpp"
#include "drivers/messages/ranges.hpp"

namespace mapweld::messages {
namespace {

constexpr auto kMaxSubmapPoints = static_cast<std::int32_t>(kCap.submap_points);
constexpr auto kMaxSubmapBytes = static_cast<std::int32_t>(kCap.submap_encoded_bytes);

}  // namespace

Status Validate(const mapweldlcm::keyframe_t& m) {
  return OkIf(IsSender(m.agent_id, m.epoch) && m.index >= 0 && m.t_ns >= 0 && IsPosition(m.odom_t_body) &&
              IsUnitQuaternion(m.odom_q_body) && IsSize(m.path_m) && Within<int>(m.flushed, 0, 1) &&
              Within(m.submap_points, 0, kMaxSubmapPoints) && Within(m.submap_bytes, 0, kMaxSubmapBytes) &&
              IsSize(m.descriptor_scale) && IsSize(m.orientation_scale));
}

Status Validate(const mapweldlcm::submap_chunk_t& m) {
  constexpr auto kMaxChunk = static_cast<int>(std::size(decltype(m.data){}));
  return OkIf(IsSender(m.agent_id, m.epoch) && m.keyframe >= 0 && Within(m.total_bytes, 1, kMaxSubmapBytes) &&
              Within<int>(m.n, 1, kMaxChunk) && Within(m.offset, 0, m.total_bytes - m.n));
}

Status Validate(const mapweldlcm::pose_t& m) {
  return OkIf(IsSender(m.agent_id, m.epoch) && m.t_ns >= 0 && IsPosition(m.odom_t_body) &&
              IsUnitQuaternion(m.odom_q_body) && m.group >= -1 && IsPosition(m.merged_t_body) &&
              IsUnitQuaternion(m.merged_q_body) && IsSize(m.sigma_m) && Within<int>(m.degenerate, 0, 1));
}

Status Validate(const mapweldlcm::health_t& m) {
  const std::int64_t lowest =
      std::min({m.t_ns, m.heap_calls + 1, m.lidar_packets, m.lidar_rejected, m.can_frames, m.imu_samples,
                m.imu_rejected, m.kernel_drops, m.scans, m.scans_dropped, m.bytes_sent, m.bus_rejected});
  return OkIf(IsSender(m.agent_id, m.epoch) && Within<int>(m.mode, 0, 4) && lowest >= 0 && m.keyframes >= 0 &&
              m.submaps_sent >= 0 && IsSize(m.scan_ms_mean) && IsSize(m.scan_ms_max) && IsSize(m.path_m));
}

}  // namespace mapweld::messages
