// SPDX-License-Identifier: Apache-2.0
#include "tools/mapweld/merge_city.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/merge/merge_pipeline.hpp"
#include "tools/store/history.hpp"
#include "tools/store/pair_memory.hpp"

namespace mapweld::merge {
namespace {

class MemoryCity final : public MergeCity {
 public:
  MemoryCity(const std::vector<MergeInput>& inputs, Crew* crew) : crew_(crew) {
    for (const MergeInput& input : inputs) {
      built_.push_back(input.build());
      drives_.push_back(built_.back().drive);
    }
  }
  MergeResult Merge(const MergeConfig& config, Progress* progress) override {
    return crew_ != nullptr ? MergeDrives(drives_, *this, config, *crew_)
                            : MergeDrives(drives_, *this, config, progress);
  }
  std::shared_ptr<const SubmapCloud> Find(SubmapKey key) override {
    const auto drive = static_cast<std::size_t>(key.drive);
    return drive < built_.size() ? built_[drive].submap(key.keyframe) : nullptr;
  }
  store::ScanTrajectory Scans(std::size_t drive) override { return built_[drive].scans; }

 private:
  Crew* crew_;
  std::vector<BuiltDrive> built_;
};

class StoredCity final : public MergeCity {
 public:
  StoredCity(const std::filesystem::path& path, const std::vector<MergeInput>& inputs, Progress* progress)
      : store_(path), submaps_(&store_, {}) {
    // Before any long work: is a name taken?
    for (const MergeInput& input : inputs) (void)Holds(input);
    for (const MergeInput& input : inputs) {
      if (!Holds(input)) Keep(input, progress);
    }
    Load();
  }
  MergeResult Merge(const MergeConfig& config, Progress* progress) override {
    store::PairMemory memory(&store_, &drives_, keys_, &config);
    const auto rulings = store::Rulings(&store_);
    const int searched = memory.SearchUnknown(&submaps_, progress);
    fmt::print(stderr, "merge: {} drives in {}; {} pairs of them searched now, {} before\n", drives_.size(),
               store_.database().path().string(), searched,
               static_cast<int>(drives_.size() * (drives_.size() - 1) / 2) - searched);
    MergeCache cache;
    memory.Fill(&cache, &submaps_);
    MergeResult result = MergeDrives(drives_, submaps_, config, progress, &cache);
    store::NameRefusals(rulings, drives_, &result);
    store::MergeRecord record = store::ToRecord(drives_, result, "merge", store::TimeLabel());
    record.is_final = true;
    store::RecordMerge(&store_, record);
    return result;
  }
  std::shared_ptr<const SubmapCloud> Find(SubmapKey key) override { return submaps_.Find(key); }
  store::ScanTrajectory Scans(std::size_t drive) override {
    return store_.Trajectory(keys_[drive]).value_or(store::ScanTrajectory{});
  }

 private:
  bool Holds(const MergeInput& input) {
    const auto known = store_.FindDrive(input.name);
    if (!known.has_value()) return false;
    if (known->info.fingerprint == input.fingerprint) return true;
    throw store::StoreError(
        fmt::format("the store {} already holds another drive called '{}'; rename this recording's folder",
                    store_.database().path().string(), input.name));
  }
  void Keep(const MergeInput& input, Progress* progress) {
    const BuiltDrive built = input.build();
    const auto count = static_cast<std::int32_t>(built.drive.keyframes.size());
    store_.Write([&] {
      store::DriveInfo info;
      info.name = input.name;
      info.published = count;
      info.ended = true;
      info.fingerprint = input.fingerprint;
      const store::DriveKey key = store_.AddDrive(info);
      for (std::int32_t k = 0; k < count; ++k) {
        store_.AddKeyframe(key, k, built.drive.keyframes[static_cast<std::size_t>(k)]);
        const store::Bytes submap = built.encoded_submap(k);
        if (!submap.empty()) store_.AddSubmap(key, k, submap);
        if (progress != nullptr) progress->Report("stored", k + 1, count);
      }
      if (!built.scans.times.empty()) store_.AddTrajectory(key, built.scans);
    });
  }
  void Load() {
    const auto rulings = store::Rulings(&store_);
    std::vector<store::StoredDrive> stored = store_.Drives();
    std::sort(stored.begin(), stored.end(), [](const auto& x, const auto& y) { return x.info.name < y.info.name; });
    for (const store::StoredDrive& drive : stored) {
      Drive loaded = store_.MergeDrive(drive);
      const bool whole = drive.info.ended && static_cast<std::int32_t>(loaded.keyframes.size()) >= drive.info.published;
      if (store::IsQuarantined(rulings, drive.info.name) || (drive.info.disputed && !whole)) {
        fmt::print(stderr, "merge: {} is set aside\n", drive.info.name);
      } else if (!loaded.keyframes.empty()) {
        drives_.push_back(std::move(loaded));
        keys_.push_back(drive.key);
      }
    }
    submaps_ = store::CitySubmaps(&store_, keys_);
    for (const std::string& name : store_.damage()) {
      fmt::print(stderr, "merge: {} is damaged and left out; see 'mapweld fsck {}'\n", name,
                 store_.database().path().string());
    }
    if (drives_.empty()) {
      throw store::StoreError(fmt::format("the store {} holds no drives to merge; name some recordings",
                                          store_.database().path().string()));
    }
  }

  store::CityStore store_;
  std::vector<store::DriveKey> keys_;
  store::CitySubmaps submaps_;
};

}  // namespace

std::vector<std::vector<io::StampedPose>> MergeCity::Trajectories(const MergeResult& result) {
  std::vector<std::vector<io::StampedPose>> out(drives_.size());
  for (std::size_t d = 0; d < drives_.size(); ++d) {
    const store::ScanTrajectory scans = Scans(d);
    if (scans.times.empty()) continue;
    const RecordedDrive recorded{drives_[d], {}, {}, scans.odom_T_scan, scans.scan_path_m};
    const std::vector<geom::Pose3> poses = MergedScanPoses(recorded, result.merged_T_body[d]);
    for (std::size_t i = 0; i < poses.size(); ++i) out[d].push_back({scans.times[i], poses[i]});
  }
  return out;
}

std::unique_ptr<MergeCity> CityInMemory(const std::vector<MergeInput>& inputs, Crew* crew) {
  return std::make_unique<MemoryCity>(inputs, crew);
}

std::unique_ptr<MergeCity> CityInStore(const std::filesystem::path& store, const std::vector<MergeInput>& inputs,
                                       Progress* progress) {
  return std::make_unique<StoredCity>(store, inputs, progress);
}

}  // namespace mapweld::merge
