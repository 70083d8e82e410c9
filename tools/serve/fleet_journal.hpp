// SPDX-License-Identifier: Apache-2.0
// Between the network and the fleet: what agents send counts as received only when it is on the disk. Until then it is
// asked for again, not counted, not merged, and no pose that depends on it is sent.
//
// When the disk fails, the mapping goes on in memory: unsaved() says how much, trouble() why, and every few seconds the
// disk is tried again.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tools/serve/fleet_store.hpp"
#include "tools/store/city_store.hpp"

namespace mapweld::serve {

class FleetJournal {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kRetry{5};

  // city: null to keep nothing. What it holds goes into the fleet. Both must outlive the journal.
  FleetJournal(store::CityStore* city, FleetStore* fleet);

  void Take(const mapweldlcm::keyframe_t& message) { keyframes_.push_back(message); }
  void Take(const mapweldlcm::health_t& message) { healths_[{message.agent_id, message.epoch}] = message; }
  void Take(const mapweldlcm::submap_chunk_t& message) { chunks_.push_back(message); }

  // Puts what was taken on the disk, then into the fleet. true: something of it was new. `fleet_mutex` is held while
  // the fleet changes, never while the disk is waited for; all calls come from one thread. Cost: one transaction, or
  // nothing when all of it was known.
  bool Commit(Clock::time_point now, std::mutex* fleet_mutex);

  // Read these under the mutex.
  [[nodiscard]] std::size_t unsaved() const { return unsaved_count_; }
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  // A record on its way to the disk.
  struct Unsaved {
    DriveId id;
    store::Table table = store::Table::kKeyframes;
    std::int32_t index = 0;
    store::Bytes body;
  };
  void Load();
  void CollectKeyframes();
  void CollectDrives();
  void Save(Clock::time_point now);
  bool Publish();
  [[nodiscard]] std::string FreeName(const DriveId& id);

  store::CityStore* city_;
  FleetStore* fleet_;
  // Taken, not yet in the fleet.
  std::vector<mapweldlcm::keyframe_t> keyframes_;
  std::map<DriveId, mapweldlcm::health_t> healths_;  // the newest
  std::vector<mapweldlcm::submap_chunk_t> chunks_;
  std::vector<WholeSubmap> submaps_;
  // On their way to the disk.
  std::vector<Unsaved> unsaved_;
  std::map<DriveId, store::DriveInfo> unsaved_drives_;
  // On the disk.
  std::map<DriveId, store::StoredDrive> saved_drives_;

  std::string error_;
  std::string trouble_;  // the same, as of the last Commit
  std::size_t unsaved_count_ = 0;
  Clock::time_point last_failure_{};
};

}  // namespace mapweld::serve
