// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/fleet_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/submap/submap_codec.hpp"

namespace mapweld::serve {
namespace {

merge::Keyframe FromMessage(const mapweldlcm::keyframe_t& m) {
  merge::Keyframe k;
  k.t = {m.t_ns};
  k.odom_T_body.t = {m.odom_t_body[0], m.odom_t_body[1], m.odom_t_body[2]};
  k.odom_T_body.q = geom::Quatd(m.odom_q_body[3], m.odom_q_body[0], m.odom_q_body[1], m.odom_q_body[2]).normalized();
  k.path_m = static_cast<double>(m.path_m);
  k.flushed = m.flushed != 0;
  k.place.descriptor.scale = m.descriptor_scale;
  std::copy(std::begin(m.descriptor), std::end(m.descriptor), k.place.descriptor.q.begin());
  k.place.orientation.scale = m.orientation_scale;
  std::copy(std::begin(m.orientation), std::end(m.orientation), k.place.orientation.q.begin());
  return k;
}

}  // namespace

std::string DriveName(const DriveId& id) {
  return id.epoch == 1 ? fmt::format("agent_{}", id.agent) : fmt::format("agent_{}_boot_{}", id.agent, id.epoch);
}

void FleetStore::Add(const mapweldlcm::keyframe_t& message) {
  DriveData& drive = drives_[{message.agent_id, message.epoch}];
  ++drive.keyframe_messages;
  const bool is_new = drive.keyframes.emplace(message.index, FromMessage(message)).second;
  ++(is_new ? counters_.keyframes : counters_.repeated_keyframes);
}

void FleetStore::Add(const mapweldlcm::health_t& message) {
  drives_[{message.agent_id, message.epoch}].health = message;
}

void FleetStore::Add(const mapweldlcm::submap_chunk_t& message) {
  DriveData& drive = drives_[{message.agent_id, message.epoch}];
  ++drive.chunk_messages;
  if (drive.submaps.contains(message.keyframe)) {
    ++counters_.repeated_chunks;
    return;
  }
  PartialSubmap& partial = drive.partial[message.keyframe];
  const auto total = static_cast<std::size_t>(message.total_bytes);
  if (partial.bytes.size() != total) {  // the first piece, or an agent that contradicts itself: start over
    partial = {};
    partial.bytes.resize(total);
  }
  if (!partial.pieces.emplace(message.offset, message.n).second) {
    ++counters_.repeated_chunks;
    return;
  }
  std::copy_n(message.data, message.n, partial.bytes.begin() + message.offset);
  std::int32_t covered = 0;
  for (const auto& [offset, n] : partial.pieces) {
    if (offset > covered) return;
    covered = std::max(covered, offset + n);
  }
  if (static_cast<std::size_t>(covered) < total) return;

  const auto submap = std::make_unique<submap::Submap>();
  const Status status = submap::DecodeSubmap(partial.bytes, submap.get());
  drive.partial.erase(message.keyframe);
  if (status != Status::kOk) {
    ++counters_.broken_submaps;
    return;
  }
  merge::SubmapCloud& cloud = drive.submaps[message.keyframe];
  cloud.points.reserve(submap->points.size());
  for (const submap::SubmapPoint& p : submap->points) cloud.points.emplace_back(p.x, p.y, p.z);
  ++counters_.submaps;
}

FleetStore::Snapshot FleetStore::Drives() const {
  Snapshot snapshot;
  for (const auto& [id, data] : drives_) {
    merge::Drive drive;
    drive.name = DriveName(id);
    for (const auto& [index, keyframe] : data.keyframes) {
      if (index != static_cast<std::int32_t>(drive.keyframes.size())) break;
      drive.keyframes.push_back(keyframe);
    }
    if (drive.keyframes.empty()) continue;
    snapshot.ids.push_back(id);
    snapshot.drives.push_back(std::move(drive));
  }
  return snapshot;
}

std::vector<std::int32_t> FleetStore::MissingKeyframes(const DriveId& id, std::size_t most) const {
  std::vector<std::int32_t> missing;
  const auto found = drives_.find(id);
  if (found == drives_.end()) return missing;
  const DriveData& drive = found->second;
  std::int32_t published = drive.keyframes.empty() ? 0 : drive.keyframes.rbegin()->first + 1;
  if (drive.health.has_value()) published = std::max(published, drive.health->keyframes);
  for (std::int32_t i = 0; i < published && missing.size() < most; ++i) {
    if (!drive.keyframes.contains(i)) missing.push_back(i);
  }
  return missing;
}

const merge::SubmapCloud* FleetStore::FindSubmap(const DriveId& id, std::int32_t keyframe) const {
  const auto drive = drives_.find(id);
  if (drive == drives_.end()) return nullptr;
  const auto submap = drive->second.submaps.find(keyframe);
  return submap == drive->second.submaps.end() ? nullptr : &submap->second;
}

bool FleetStore::IsComplete(const DriveId& id) const {
  const auto health = Health(id);
  constexpr int kModeEnded = 4;
  return health.has_value() && health->mode == kModeEnded && MissingKeyframes(id, 1).empty();
}

std::vector<DriveId> FleetStore::Ids() const {
  std::vector<DriveId> ids;
  for (const auto& [id, data] : drives_) ids.push_back(id);
  return ids;
}

std::optional<mapweldlcm::health_t> FleetStore::Health(const DriveId& id) const {
  const auto found = drives_.find(id);
  return found == drives_.end() ? std::nullopt : found->second.health;
}

std::uint64_t FleetStore::KeyframeBytes(const DriveId& id) const {
  const auto found = drives_.find(id);
  const auto bytes = static_cast<std::uint64_t>(mapweldlcm::keyframe_t{}.getEncodedSize());
  return found == drives_.end() ? 0 : found->second.keyframe_messages * bytes;
}

std::uint64_t FleetStore::SubmapBytes(const DriveId& id) const {
  const auto found = drives_.find(id);
  const auto bytes = static_cast<std::uint64_t>(mapweldlcm::submap_chunk_t{}.getEncodedSize());
  return found == drives_.end() ? 0 : found->second.chunk_messages * bytes;
}

}  // namespace mapweld::serve
