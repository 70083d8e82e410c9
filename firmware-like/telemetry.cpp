// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/telemetry.hpp"

#include <algorithm>

namespace mapweld::executive {
namespace {

void PutPose(const geom::Pose3& pose, double (&t)[3], double (&q)[4]) {
  for (int i = 0; i < 3; ++i) t[i] = pose.t(i);
  for (int i = 0; i < 4; ++i) q[i] = pose.q.coeffs()(i);  // x, y, z, w
}

}  // namespace

void Telemetry::Send(messages::Kind kind, std::span<const std::uint8_t> encoded) {
  messages::ChannelBuffer buffer;
  const auto channel = messages::FormatChannel(&buffer, identity_.agent_id, kind);
  if (channel.ok()) (void)bus_->Publish(channel.value(), encoded);
}

void Telemetry::PublishPose(const pipeline::PoseOutput& pose) {
  mapweldlcm::pose_t message{};
  message.agent_id = identity_.agent_id;
  message.epoch = identity_.epoch;
  message.t_ns = pose.odometry.t.ns;
  PutPose(pose.odometry.odom_T_body, message.odom_t_body, message.odom_q_body);
  message.group = pose.group;
  PutPose(pose.merged_T_body, message.merged_t_body, message.merged_q_body);
  message.sigma_m = static_cast<float>(pose.odometry.sigma_m);
  message.degenerate = pose.odometry.degenerate ? 1 : 0;
  (void)Publish(messages::Kind::kPose, message);
}

std::span<const std::uint8_t> Telemetry::PublishKeyframe(const pipeline::KeyframeOutput& keyframe) {
  keyframe_.agent_id = identity_.agent_id;
  keyframe_.epoch = identity_.epoch;
  keyframe_.index = keyframe.index;
  keyframe_.t_ns = keyframe.t.ns;
  PutPose(keyframe.odom_T_body, keyframe_.odom_t_body, keyframe_.odom_q_body);
  keyframe_.path_m = static_cast<float>(keyframe.path_m);
  keyframe_.flushed = keyframe.flushed ? 1 : 0;
  keyframe_.submap_points = static_cast<std::int32_t>(keyframe.submap_points);
  keyframe_.submap_bytes = static_cast<std::int32_t>(keyframe.encoded.size());
  keyframe_.descriptor_scale = keyframe.place.descriptor.scale;
  std::copy(keyframe.place.descriptor.q.begin(), keyframe.place.descriptor.q.end(), keyframe_.descriptor);
  keyframe_.orientation_scale = keyframe.place.orientation.scale;
  std::copy(keyframe.place.orientation.q.begin(), keyframe.place.orientation.q.end(), keyframe_.orientation);
  return Publish(messages::Kind::kKeyframe, keyframe_);
}

void Telemetry::PublishHealth(mapweldlcm::health_t* health) {
  health->agent_id = identity_.agent_id;
  health->epoch = identity_.epoch;
  (void)Publish(messages::Kind::kHealth, *health);
}

std::size_t Telemetry::PublishSubmapChunk(std::int32_t epoch, std::int32_t keyframe,
                                          std::span<const std::uint8_t> submap, std::size_t offset) {
  static_assert(sizeof(chunk_.data) == kChunkBytes);
  const std::size_t n = std::min(kChunkBytes, submap.size() - offset);
  chunk_.agent_id = identity_.agent_id;
  chunk_.epoch = epoch;
  chunk_.keyframe = keyframe;
  chunk_.total_bytes = static_cast<std::int32_t>(submap.size());
  chunk_.offset = static_cast<std::int32_t>(offset);
  chunk_.n = static_cast<std::int16_t>(n);
  std::copy_n(submap.data() + offset, n, chunk_.data);
  (void)Publish(messages::Kind::kSubmapChunk, chunk_);
  return n;
}

}  // namespace mapweld::executive
