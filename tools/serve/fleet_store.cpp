// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/fleet_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/submap/submap_codec.hpp"

namespace mapweld::serve {
namespace {

// The same keyframe sent again is the same to the bit; only another vehicle sends another.
bool IsSame(const merge::Keyframe& x, const merge::Keyframe& y) {
  return x.t.ns == y.t.ns && x.odom_T_body.t == y.odom_T_body.t &&
         x.odom_T_body.q.coeffs() == y.odom_T_body.q.coeffs() && x.place.descriptor.q == y.place.descriptor.q;
}

}  // namespace

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

std::string DriveName(const DriveId& id) {
  return id.epoch == 1 ? fmt::format("agent_{}", id.agent) : fmt::format("agent_{}_boot_{}", id.agent, id.epoch);
}

const FleetStore::DriveData* FleetStore::Find(const DriveId& id) const {
  const auto found = drives_.find(id);
  return found == drives_.end() ? nullptr : &found->second;
}

void FleetStore::Advance(DriveData* drive) const {
  while (drive->keyframes.contains(drive->contiguous)) ++drive->contiguous;
  if (!drive->keyframes.empty()) {
    drive->published = std::max(drive->published, drive->keyframes.rbegin()->first + 1);
  }
}

void FleetStore::Add(const mapweldlcm::keyframe_t& message) {
  const DriveId id{message.agent_id, message.epoch};
  DriveData& drive = drives_[id];
  ++drive.keyframe_messages;
  const bool contradicts = Contradicts(message);
  if (contradicts && !drive.disputed) {
    drive.left_out = !IsComplete(id);
    drive.disputed = true;
  }
  if (!contradicts && drive.keyframes.contains(message.index)) {
    ++counters_.repeated_keyframes;
    return;
  }
  if (drive.disputed) {
    ++counters_.disputed_keyframes;
    return;
  }
  drive.keyframes.emplace(message.index, FromMessage(message));
  Advance(&drive);
  ++counters_.keyframes;
}

void FleetStore::Add(const mapweldlcm::health_t& message) {
  DriveData& drive = drives_[{message.agent_id, message.epoch}];
  drive.health = message;
  if (drive.disputed) return;
  drive.published = std::max(drive.published, message.keyframes);
  drive.ended = drive.ended || message.mode == kModeEnded;
}

std::optional<WholeSubmap> FleetStore::Assemble(const mapweldlcm::submap_chunk_t& message) {
  const DriveId id{message.agent_id, message.epoch};
  DriveData& drive = drives_[id];
  ++drive.chunk_messages;
  if (drive.disputed) return std::nullopt;
  if (drive.submaps.contains(message.keyframe)) {
    ++counters_.repeated_chunks;
    return std::nullopt;
  }
  const std::uint64_t repeated = assembly_.repeated();
  auto encoded = assembly_.Add(message);
  counters_.repeated_chunks += assembly_.repeated() - repeated;
  if (!encoded.has_value()) return std::nullopt;
  const auto submap = std::make_unique<submap::Submap>();
  if (submap::DecodeSubmap(*encoded, submap.get()) != Status::kOk) {
    ++counters_.broken_submaps;
    return std::nullopt;
  }
  WholeSubmap whole{id, message.keyframe, std::move(*encoded), {}};
  whole.cloud.points.reserve(submap->points.size());
  for (const submap::SubmapPoint& p : submap->points) whole.cloud.points.emplace_back(p.x, p.y, p.z);
  return whole;
}

void FleetStore::AddSubmap(WholeSubmap submap) {
  DriveData& drive = drives_[submap.id];
  if (drive.submaps.emplace(submap.keyframe, std::move(submap.cloud)).second) ++counters_.submaps;
}

void FleetStore::Add(const mapweldlcm::submap_chunk_t& message) {
  auto whole = Assemble(message);
  if (whole.has_value()) AddSubmap(std::move(*whole));
}

void FleetStore::Restore(const DriveId& id, Restored restored) {
  DriveData& drive = drives_[id];
  drive.name = std::move(restored.name);
  drive.keyframes = std::move(restored.keyframes);
  drive.submaps = std::move(restored.submaps);
  drive.published = restored.published;
  drive.ended = restored.ended;
  Advance(&drive);
  counters_.keyframes += drive.keyframes.size();
  counters_.submaps += drive.submaps.size();
  drive.left_out = restored.disputed && !IsComplete(id);
  drive.disputed = restored.disputed;
}

FleetStore::Snapshot FleetStore::Drives() const {
  Snapshot snapshot;
  for (const auto& [id, data] : drives_) {
    if (data.left_out || data.contiguous == 0) continue;
    merge::Drive drive;
    drive.name = NameOf(id);
    for (std::int32_t k = 0; k < data.contiguous; ++k) drive.keyframes.push_back(data.keyframes.at(k));
    snapshot.ids.push_back(id);
    snapshot.drives.push_back(std::move(drive));
  }
  return snapshot;
}

std::vector<std::int32_t> FleetStore::MissingKeyframes(const DriveId& id, std::size_t most) const {
  std::vector<std::int32_t> missing;
  const DriveData* drive = Find(id);
  if (drive == nullptr || drive->disputed) return missing;
  for (std::int32_t i = drive->contiguous; i < drive->published && missing.size() < most; ++i) {
    if (!drive->keyframes.contains(i)) missing.push_back(i);
  }
  return missing;
}

bool FleetStore::Contradicts(const mapweldlcm::keyframe_t& message) const {
  const DriveId id{message.agent_id, message.epoch};
  const DriveData* drive = Find(id);
  if (drive == nullptr) return false;
  const auto known = drive->keyframes.find(message.index);
  if (known != drive->keyframes.end()) return !IsSame(known->second, FromMessage(message));
  return IsComplete(id);  // one more than there were
}

bool FleetStore::HasKeyframe(const DriveId& id, std::int32_t index) const {
  const DriveData* drive = Find(id);
  return drive != nullptr && drive->keyframes.contains(index);
}

const merge::SubmapCloud* FleetStore::FindSubmap(const DriveId& id, std::int32_t keyframe) const {
  const DriveData* drive = Find(id);
  if (drive == nullptr) return nullptr;
  const auto submap = drive->submaps.find(keyframe);
  return submap == drive->submaps.end() ? nullptr : &submap->second;
}

bool FleetStore::IsComplete(const DriveId& id) const {
  const DriveData* drive = Find(id);
  return drive != nullptr && drive->ended && drive->contiguous >= drive->published;
}

bool FleetStore::IsDisputed(const DriveId& id) const {
  const DriveData* drive = Find(id);
  return drive != nullptr && drive->disputed;
}

bool FleetStore::HasEnded(const DriveId& id) const {
  const DriveData* drive = Find(id);
  return drive != nullptr && drive->ended;
}

std::int32_t FleetStore::Published(const DriveId& id) const {
  const DriveData* drive = Find(id);
  return drive == nullptr ? 0 : drive->published;
}

std::string FleetStore::NameOf(const DriveId& id) const {
  const DriveData* drive = Find(id);
  return drive == nullptr || drive->name.empty() ? DriveName(id) : drive->name;
}

std::vector<DriveId> FleetStore::Ids() const {
  std::vector<DriveId> ids;
  for (const auto& [id, data] : drives_) ids.push_back(id);
  return ids;
}

std::optional<mapweldlcm::health_t> FleetStore::Health(const DriveId& id) const {
  const DriveData* drive = Find(id);
  return drive == nullptr ? std::nullopt : drive->health;
}

std::uint64_t FleetStore::KeyframeBytes(const DriveId& id) const {
  const DriveData* drive = Find(id);
  const auto bytes = static_cast<std::uint64_t>(mapweldlcm::keyframe_t{}.getEncodedSize());
  return drive == nullptr ? 0 : drive->keyframe_messages * bytes;
}

std::uint64_t FleetStore::SubmapBytes(const DriveId& id) const {
  const DriveData* drive = Find(id);
  const auto bytes = static_cast<std::uint64_t>(mapweldlcm::submap_chunk_t{}.getEncodedSize());
  return drive == nullptr ? 0 : drive->chunk_messages * bytes;
}

}  // namespace mapweld::serve
