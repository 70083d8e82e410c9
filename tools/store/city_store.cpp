// SPDX-License-Identifier: Apache-2.0
#include "tools/store/city_store.hpp"

#include <fmt/format.h>

namespace mapweld::store {
namespace {

constexpr std::int64_t FirstOf(DriveKey drive) {
  return PairKey(drive, 0);
}
constexpr std::int64_t LastOf(DriveKey drive) {
  return PairKey(drive, INT32_MAX);
}

}  // namespace

std::string RecordName(Table table, std::int64_t key, const std::map<DriveKey, std::string>& names) {
  const auto name = [&](DriveKey drive) {
    const auto known = names.find(drive);
    return known == names.end() ? fmt::format("drive {}", drive) : known->second;
  };
  switch (table) {
    case Table::kDrives:
      return fmt::format("drive {}", key);
    case Table::kKeyframes:
      return fmt::format("keyframe {} of {}", LowOf(key), name(HighOf(key)));
    case Table::kSubmaps:
      return fmt::format("submap {} of {}", LowOf(key), name(HighOf(key)));
    case Table::kTrajectories:
      return fmt::format("trajectory of {}", name(key));
    case Table::kPairs:
      return fmt::format("search of {} and {}", name(HighOf(key)), name(LowOf(key)));
    case Table::kMerges:
      return fmt::format("merge {}", key);
    case Table::kRulings:
      return fmt::format("ruling {}", key);
  }
  return "record";
}

std::vector<StoredDrive> CityStore::Drives() {
  std::vector<StoredDrive> drives;
  database_.ForEach(Table::kDrives, 0, INT64_MAX, [&](const Record& record) {
    auto info = Decoded<DriveInfo>(Table::kDrives, record);
    if (info.has_value()) drives.push_back({record.key, std::move(*info)});
  });
  return drives;
}

std::optional<StoredDrive> CityStore::FindDrive(const std::string& name) {
  for (StoredDrive& drive : Drives()) {
    if (drive.info.name == name) return std::move(drive);
  }
  return std::nullopt;
}

DriveKey CityStore::AddDrive(const DriveInfo& info) {
  DriveKey key = 1;
  Write([&] {
    if (FindDrive(info.name).has_value()) {
      throw StoreError(fmt::format("the store {} already holds a drive called '{}'; give this one another name",
                                   database_.path().string(), info.name));
    }
    const std::vector<std::int64_t> keys = database_.Keys(Table::kDrives);
    if (!keys.empty()) key = keys.back() + 1;
    database_.Put(Table::kDrives, key, Encode(info));
  });
  return key;
}

void CityStore::UpdateDrive(DriveKey drive, const DriveInfo& info) {
  database_.Put(Table::kDrives, drive, Encode(info));
}

void CityStore::AddKeyframe(DriveKey drive, std::int32_t index, const merge::Keyframe& keyframe) {
  database_.Put(Table::kKeyframes, PairKey(drive, index), Encode(keyframe));
}

void CityStore::AddSubmap(DriveKey drive, std::int32_t keyframe, const Bytes& encoded) {
  database_.Put(Table::kSubmaps, PairKey(drive, keyframe), encoded);
}

void CityStore::AddTrajectory(DriveKey drive, const ScanTrajectory& trajectory) {
  database_.Put(Table::kTrajectories, drive, Encode(trajectory));
}

std::map<std::int32_t, merge::Keyframe> CityStore::Keyframes(DriveKey drive) {
  std::map<std::int32_t, merge::Keyframe> keyframes;
  database_.ForEach(Table::kKeyframes, FirstOf(drive), LastOf(drive), [&](const Record& record) {
    auto keyframe = Decoded<merge::Keyframe>(Table::kKeyframes, record);
    if (keyframe.has_value()) keyframes.emplace(LowOf(record.key), *keyframe);
  });
  return keyframes;
}

merge::Drive CityStore::MergeDrive(const StoredDrive& drive) {
  merge::Drive out;
  out.name = drive.info.name;
  for (const auto& [index, keyframe] : Keyframes(drive.key)) {
    if (index != static_cast<std::int32_t>(out.keyframes.size())) break;
    out.keyframes.push_back(keyframe);
  }
  return out;
}

std::vector<std::int32_t> CityStore::SubmapKeyframes(DriveKey drive) {
  std::vector<std::int32_t> keyframes;
  for (const std::int64_t key : database_.Keys(Table::kSubmaps, FirstOf(drive), LastOf(drive))) {
    keyframes.push_back(LowOf(key));
  }
  return keyframes;
}

std::shared_ptr<const merge::SubmapCloud> CityStore::Submap(DriveKey drive, std::int32_t keyframe) {
  auto cloud = Read<merge::SubmapCloud>(Table::kSubmaps, PairKey(drive, keyframe));
  return cloud.has_value() ? std::make_shared<const merge::SubmapCloud>(std::move(*cloud)) : nullptr;
}

bool CityStore::HasSubmap(DriveKey drive, std::int32_t keyframe) {
  const std::optional<Record> record = database_.Get(Table::kSubmaps, PairKey(drive, keyframe));
  if (!record.has_value()) return false;
  if (record->damaged) NoteDamage(Table::kSubmaps, record->key);
  return !record->damaged;
}

std::optional<ScanTrajectory> CityStore::Trajectory(DriveKey drive) {
  return Read<ScanTrajectory>(Table::kTrajectories, drive);
}

void CityStore::NoteDamage(Table table, std::int64_t key) {
  const std::lock_guard lock(damage_mutex_);
  damage_.emplace(table, key);
}

std::vector<std::string> CityStore::damage() {
  std::map<DriveKey, std::string> names;
  for (const StoredDrive& drive : Drives()) names.emplace(drive.key, drive.info.name);
  std::vector<std::string> out;
  const std::lock_guard lock(damage_mutex_);
  for (const auto& [table, key] : damage_) out.push_back(RecordName(table, key, names));
  return out;
}

std::shared_ptr<const merge::SubmapCloud> CitySubmaps::Find(merge::SubmapKey key) {
  return IsDrive(key.drive) ? store_->Submap(keys_[static_cast<std::size_t>(key.drive)], key.keyframe) : nullptr;
}

bool CitySubmaps::Has(merge::SubmapKey key) {
  return IsDrive(key.drive) && store_->HasSubmap(keys_[static_cast<std::size_t>(key.drive)], key.keyframe);
}

}  // namespace mapweld::store
