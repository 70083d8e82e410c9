// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/fleet_journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace mapweld::serve {
namespace {

DriveId IdOf(const store::StoredDrive& drive) {
  const bool recording = drive.info.agent == 0;
  return {drive.info.agent, recording ? static_cast<std::int32_t>(drive.key) : drive.info.epoch};
}

}  // namespace

FleetJournal::FleetJournal(store::CityStore* city, FleetStore* fleet) : city_(city), fleet_(fleet) {
  if (city_ != nullptr) Load();
}

void FleetJournal::Load() {
  for (const store::StoredDrive& drive : city_->Drives()) {
    FleetStore::Restored restored;
    restored.name = drive.info.name;
    restored.keyframes = city_->Keyframes(drive.key);
    for (const std::int32_t keyframe : city_->SubmapKeyframes(drive.key)) {
      const auto cloud = city_->Submap(drive.key, keyframe);
      if (cloud != nullptr) restored.submaps.emplace(keyframe, *cloud);
    }
    restored.published = drive.info.published;
    restored.ended = drive.info.ended;
    restored.disputed = drive.info.disputed;
    fleet_->Restore(IdOf(drive), std::move(restored));
    saved_drives_.emplace(IdOf(drive), drive);
  }
}

bool FleetJournal::Commit(Clock::time_point now, std::mutex* fleet_mutex) {
  {
    const std::lock_guard lock(*fleet_mutex);
    for (const mapweldlcm::submap_chunk_t& chunk : chunks_) {
      auto whole = fleet_->Assemble(chunk);
      if (whole.has_value()) submaps_.push_back(std::move(*whole));
    }
    chunks_.clear();
  }
  // Nobody else changes the fleet, so it can be read without the mutex.
  if (city_ != nullptr) {
    CollectKeyframes();
    for (const WholeSubmap& submap : submaps_) {
      unsaved_.push_back({submap.id, store::Table::kSubmaps, submap.keyframe, store::EncodedByAgent(submap.encoded)});
    }
    CollectDrives();
    if (!unsaved_.empty() || !unsaved_drives_.empty()) Save(now);
  }
  const std::lock_guard lock(*fleet_mutex);
  trouble_ = error_;
  unsaved_count_ = unsaved_.size();
  return Publish();
}

void FleetJournal::CollectKeyframes() {
  std::map<std::pair<DriveId, std::int32_t>, const mapweldlcm::keyframe_t*> fresh;  // the first of each
  std::set<DriveId> disputed;
  for (const mapweldlcm::keyframe_t& message : keyframes_) {
    const DriveId id{message.agent_id, message.epoch};
    if (fleet_->Contradicts(message)) disputed.insert(id);
    if (disputed.contains(id) || fleet_->IsDisputed(id) || fleet_->HasKeyframe(id, message.index)) continue;
    fresh.emplace(std::pair(id, message.index), &message);
  }
  for (const auto& [key, message] : fresh) {
    unsaved_.push_back({key.first, store::Table::kKeyframes, key.second, store::Encode(FromMessage(*message))});
  }
}

// The drives whose own record is no longer what the disk holds.
void FleetJournal::CollectDrives() {
  std::map<DriveId, store::DriveInfo> wanted;
  const auto info = [&](const DriveId& id) -> store::DriveInfo& {
    const auto known = wanted.find(id);
    if (known != wanted.end()) return known->second;
    store::DriveInfo fresh;
    const auto saved = saved_drives_.find(id);
    if (saved != saved_drives_.end()) {
      fresh = saved->second.info;
    } else {
      fresh.agent = id.agent;
      fresh.epoch = id.epoch;
    }
    return wanted.emplace(id, std::move(fresh)).first->second;
  };
  for (const Unsaved& record : unsaved_) info(record.id);
  for (const auto& [id, health] : healths_) {
    if (health.keyframes == 0 && !saved_drives_.contains(id)) continue;  // nothing to remember yet
    if (fleet_->IsDisputed(id)) continue;
    store::DriveInfo& drive = info(id);
    drive.published = std::max(drive.published, health.keyframes);
    drive.ended = drive.ended || health.mode == kModeEnded;
  }
  for (const DriveId& id : fleet_->Ids()) {
    if (fleet_->IsDisputed(id)) info(id).disputed = true;
  }
  unsaved_drives_.clear();
  for (const auto& [id, drive] : wanted) {
    const auto saved = saved_drives_.find(id);
    if (saved == saved_drives_.end() || !(saved->second.info == drive)) unsaved_drives_.emplace(id, drive);
  }
}

std::string FleetJournal::FreeName(const DriveId& id) {
  std::string name = DriveName(id);
  for (int i = 2; city_->FindDrive(name).has_value(); ++i) name = fmt::format("{}_{}", DriveName(id), i);
  return name;
}

void FleetJournal::Save(Clock::time_point now) {
  if (!error_.empty() && now - last_failure_ < kRetry) return;
  auto saved = saved_drives_;  // in force only when the transaction is
  try {
    city_->Write([&] {
      for (auto& [id, info] : unsaved_drives_) {
        const auto known = saved.find(id);
        if (known != saved.end()) {
          city_->UpdateDrive(known->second.key, info);
          known->second.info = info;
        } else {
          info.name = FreeName(id);
          saved.emplace(id, store::StoredDrive{city_->AddDrive(info), info});
        }
      }
      for (const Unsaved& record : unsaved_) {
        city_->database().Put(record.table, store::PairKey(saved.at(record.id).key, record.index), record.body);
      }
    });
  } catch (const store::StoreError& error) {
    error_ = error.what();
    last_failure_ = now;
    return;
  }
  saved_drives_ = std::move(saved);
  unsaved_.clear();
  unsaved_drives_.clear();
  error_.clear();
}

bool FleetJournal::Publish() {
  const FleetCounters before = fleet_->counters();
  bool news = false;
  for (const mapweldlcm::keyframe_t& message : keyframes_) fleet_->Add(message);
  for (const auto& [id, health] : healths_) {
    const bool ended = fleet_->HasEnded(id);
    const std::int32_t published = fleet_->Published(id);
    fleet_->Add(health);
    news = news || ended != fleet_->HasEnded(id) || published != fleet_->Published(id);
  }
  for (WholeSubmap& submap : submaps_) fleet_->AddSubmap(std::move(submap));
  keyframes_.clear();
  healths_.clear();
  submaps_.clear();
  for (const auto& [id, drive] : saved_drives_) {
    if (fleet_->NameOf(id) != drive.info.name) fleet_->Rename(id, drive.info.name);
  }
  const FleetCounters& after = fleet_->counters();
  return news || after.keyframes != before.keyframes || after.submaps != before.submaps ||
         after.disputed_keyframes != before.disputed_keyframes;
}

}  // namespace mapweld::serve
