// SPDX-License-Identifier: Apache-2.0
// `mapweld serve`: collects what agents send, merges again whenever enough is new, tells every agent where it is. With
// a store it goes on where an earlier one ended or was killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "tools/merge/merge_cache.hpp"
#include "tools/merge/merge_pipeline.hpp"
#include "tools/serve/fleet_link.hpp"
#include "tools/serve/requester.hpp"
#include "tools/store/history.hpp"

namespace mapweld::serve {

struct ServeOptions {
  std::string lcm_url;  // empty: $LCM_DEFAULT_URL, else LCM's default
  std::filesystem::path out;
  std::filesystem::path store;    // the city's file; empty: nothing lasts
  int agents = 0;                 // end when this many have ended their drives; 0: on SIGINT or SIGTERM
  double submap_bytes_per_s = 0;  // asked of all agents together; 0: as fast as they allow themselves
  std::map<std::string, std::filesystem::path> truth;  // by drive name, for the errors in the report
  merge::MergeConfig merge;
};

class Server {
 public:
  explicit Server(ServeOptions options);
  // Until all agents are done or a signal asks for the end; then the last merge, the files and the table. A second
  // signal ends at once. Throws when something could not be stored.
  void Run();

 private:
  struct Merged {
    FleetStore::Snapshot fleet;
    merge::MergeResult result;
  };

  [[nodiscard]] bool IsDue();
  [[nodiscard]] bool AllEnded();
  Merged MergeOnce(merge::MergeCache* cache);
  void WantMissing(const Merged& merged, const merge::MergeCache& cache);
  void SendBack(const Merged& merged);
  void Record(const Merged& merged, bool is_final);
  Merged MergeForGood();
  void Fill(const FleetStore::Snapshot& fleet, merge::MergeCache* cache);
  void Keep(const Merged& merged, const merge::MergeCache& cache);
  [[nodiscard]] std::vector<store::DriveKey> KeysOf(const FleetStore::Snapshot& fleet);
  std::size_t Fetch();
  void FetchMap(const Merged& merged);
  void WriteOutput(const Merged& merged);
  void ReportProgress();

  ServeOptions options_;
  std::unique_ptr<store::CityStore> city_;  // null: nothing lasts
  std::vector<store::NumberedRuling> rulings_;
  std::set<std::string> settled_;  // drives of the last run that came to its end
  FleetLink link_;
  Requester requester_;
  merge::MergeCache cache_;
  std::int32_t revision_;
  int merges_ = 0;
  std::uint64_t merged_keyframes_ = 0;  // when the last merge began
  std::uint64_t merged_submaps_ = 0;
  double started_s_ = 0;
  double drives_ended_s_ = 0;
  double fetched_s_ = 0;
  double last_merge_s_ = 0;
  double merge_cost_s_ = 0;
  double last_progress_s_ = 0;
  std::string last_progress_;
  std::set<std::string> warned_;
};

}  // namespace mapweld::serve
