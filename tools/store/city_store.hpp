// SPDX-License-Identifier: Apache-2.0
// A city in one file: drives, their keyframes and submaps, the merges that were made of them and what people decided.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/store/database.hpp"
#include "tools/store/record_codec.hpp"

namespace mapweld::store {

using DriveKey = std::int64_t;  // 1, 2, ... in the order in which drives came

struct StoredDrive {
  DriveKey key = 0;
  DriveInfo info;
};

// Safe to use from several threads. Every function throws StoreError when the disk fails. A damaged record is left out,
// as if it were not there, and named in damage().
class CityStore {
 public:
  explicit CityStore(const std::filesystem::path& path, Database::Mode mode = Database::Mode::kCreate,
                     const char* vfs = nullptr)
      : database_(path, mode, vfs) {}

  // See Database::Transaction: all of it or nothing.
  void Write(const std::function<void()>& writes) { database_.Transaction(writes); }

  [[nodiscard]] std::vector<StoredDrive> Drives();
  [[nodiscard]] std::optional<StoredDrive> FindDrive(const std::string& name);
  // Throws StoreError when the name is taken.
  DriveKey AddDrive(const DriveInfo& info);
  void UpdateDrive(DriveKey drive, const DriveInfo& info);

  void AddKeyframe(DriveKey drive, std::int32_t index, const merge::Keyframe& keyframe);
  void AddSubmap(DriveKey drive, std::int32_t keyframe, const Bytes& encoded);
  void AddTrajectory(DriveKey drive, const ScanTrajectory& trajectory);

  [[nodiscard]] std::map<std::int32_t, merge::Keyframe> Keyframes(DriveKey drive);
  // Keyframes 0..n-1 without a gap, as the merge wants them.
  [[nodiscard]] merge::Drive MergeDrive(const StoredDrive& drive);
  [[nodiscard]] std::vector<std::int32_t> SubmapKeyframes(DriveKey drive);
  [[nodiscard]] std::shared_ptr<const merge::SubmapCloud> Submap(DriveKey drive, std::int32_t keyframe);
  // Whether its bytes are there and undamaged; decodes nothing.
  [[nodiscard]] bool HasSubmap(DriveKey drive, std::int32_t keyframe);
  [[nodiscard]] std::optional<ScanTrajectory> Trajectory(DriveKey drive);

  // Damaged records that were met and left out, each named once, "keyframe 17 of agent_3".
  [[nodiscard]] std::vector<std::string> damage();
  [[nodiscard]] Database& database() { return database_; }

  template <class T>
  std::optional<T> Read(Table table, std::int64_t key) {
    std::optional<Record> record = database_.Get(table, key);
    if (!record.has_value()) return std::nullopt;
    return Decoded<T>(table, *record);
  }
  // Null for a damaged record, which is noted.
  template <class T>
  std::optional<T> Decoded(Table table, const Record& record) {
    T value;
    if (!record.damaged && Decode(record.body, &value)) return value;
    NoteDamage(table, record.key);
    return std::nullopt;
  }

 private:
  void NoteDamage(Table table, std::int64_t key);

  Database database_;
  std::mutex damage_mutex_;
  std::set<std::pair<Table, std::int64_t>> damage_;
};

// "keyframe 17 of agent_3"; drives without a readable name are "drive 4".
std::string RecordName(Table table, std::int64_t key, const std::map<DriveKey, std::string>& names);

// The submaps of stored drives, for the merge.
class CitySubmaps final : public merge::SubmapSource {
 public:
  // keys: of the drives in the order given to the merge.
  CitySubmaps(CityStore* store, std::vector<DriveKey> keys) : store_(store), keys_(std::move(keys)) {}
  std::shared_ptr<const merge::SubmapCloud> Find(merge::SubmapKey key) override;
  bool Has(merge::SubmapKey key) override;

 private:
  [[nodiscard]] bool IsDrive(int drive) const { return drive >= 0 && static_cast<std::size_t>(drive) < keys_.size(); }

  CityStore* store_;
  std::vector<DriveKey> keys_;
};

}  // namespace mapweld::store
