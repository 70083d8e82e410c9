// SPDX-License-Identifier: Apache-2.0
// One good message of each type.
#pragma once

#include <cstdint>

#include "drivers/messages/validate.hpp"

namespace mapweld::test {

template <class T>
T SampleMessage();

template <>
inline mapweldlcm::keyframe_t SampleMessage() {
  mapweldlcm::keyframe_t m{};
  m.agent_id = 3;
  m.epoch = 7;
  m.index = 12;
  m.t_ns = 123'456'789'012;
  m.odom_t_body[0] = -1.5;
  m.odom_q_body[2] = 0.6;
  m.odom_q_body[3] = 0.8;
  m.path_m = 60.0F;
  m.submap_points = 20'000;
  m.submap_bytes = 100'000;
  m.descriptor_scale = 0.01F;
  for (int i = 0; i < 1024; ++i) m.descriptor[i] = static_cast<std::int8_t>(i % 255 - 127);
  m.orientation_scale = 0.5F;
  for (int i = 0; i < 192; ++i) m.orientation[i] = static_cast<std::int8_t>(i % 100);
  return m;
}

template <>
inline mapweldlcm::submap_chunk_t SampleMessage() {
  mapweldlcm::submap_chunk_t m{};
  m.agent_id = 3;
  m.epoch = 7;
  m.keyframe = 12;
  m.total_bytes = 100'000;
  m.offset = 2560;
  m.n = 1280;
  for (int i = 0; i < 1280; ++i) m.data[i] = static_cast<std::uint8_t>(i);
  return m;
}

template <>
inline mapweldlcm::pose_t SampleMessage() {
  mapweldlcm::pose_t m{};
  m.agent_id = 3;
  m.epoch = 7;
  m.t_ns = 123'456'789'012;
  m.odom_t_body[1] = 2.25;
  m.odom_q_body[3] = 1.0;
  m.group = -1;
  m.merged_t_body[1] = 2.25;
  m.merged_q_body[3] = 1.0;
  m.sigma_m = 0.1F;
  return m;
}

template <>
inline mapweldlcm::health_t SampleMessage() {
  mapweldlcm::health_t m{};
  m.agent_id = 3;
  m.epoch = 7;
  m.t_ns = 123'456'789'012;
  m.mode = 2;
  m.lidar_packets = 754;
  m.can_frames = 2000;
  m.imu_samples = 400;
  m.scan_ms_mean = 12.5F;
  m.path_m = 100.0F;
  return m;
}

template <>
inline mapweldlcm::global_pose_t SampleMessage() {
  mapweldlcm::global_pose_t m{};
  m.agent_id = 3;
  m.epoch = 7;
  m.keyframe = 12;
  m.group = 1;
  m.revision = 4;
  m.merged_t_body[0] = 1000.0;
  m.merged_q_body[1] = 1.0;
  m.sigma_m = 0.3F;
  m.sigma_rad = 0.01F;
  return m;
}

template <>
inline mapweldlcm::request_t SampleMessage() {
  mapweldlcm::request_t m{};
  m.agent_id = 3;
  m.epoch = 7;
  m.kind = mapweldlcm::request_t::KIND_SUBMAP;
  m.n = 64;
  for (int i = 0; i < 64; ++i) m.index[i] = i * 3;
  return m;
}

template <>
inline mapweldlcm::command_t SampleMessage() {
  mapweldlcm::command_t m{};
  m.agent_id = 3;
  m.command = mapweldlcm::command_t::COMMAND_END_DRIVE;
  return m;
}

}  // namespace mapweld::test
