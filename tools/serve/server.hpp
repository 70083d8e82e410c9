// SPDX-License-Identifier: Apache-2.0
// `mapweld serve`: collects what agents send, merges again whenever enough is new, tells every agent where it is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/merge/merge_cache.hpp"
#include "tools/merge/merge_pipeline.hpp"
#include "tools/serve/fleet_link.hpp"
#include "tools/serve/requester.hpp"

namespace mapweld::serve {

struct ServeOptions {
  std::string lcm_url;  // empty: $LCM_DEFAULT_URL, else LCM's default
  std::filesystem::path out;
  int agents = 0;  // end when this many have ended their drives; 0: on SIGINT or SIGTERM
  std::map<std::string, std::filesystem::path> truth;  // by drive name, for the errors in the report
  merge::MergeConfig merge;
};

class Server {
 public:
  explicit Server(ServeOptions options);
  // Until all agents are done or a signal asks for the end; then the last merge, the files and the table.
  void Run();

 private:
  struct Merged {
    FleetStore::Snapshot fleet;
    merge::MergeResult result;
  };

  [[nodiscard]] bool IsDue();
  [[nodiscard]] bool AllEnded();
  Merged MergeOnce(merge::MergeCache* cache);
  void WantMissing(const Merged& merged);
  void SendBack(const Merged& merged);
  Merged MergeForGood();
  std::size_t Fetch();
  void FetchMap(const Merged& merged);
  void WriteOutput(const Merged& merged);
  void ReportProgress();

  ServeOptions options_;
  FleetLink link_;
  Requester requester_;
  merge::MergeCache cache_;
  std::int32_t revision_ = 0;
  std::uint64_t merged_keyframes_ = 0;  // when the last merge began
  std::size_t merged_submaps_ = 0;
  double started_s_ = 0;
  double drives_ended_s_ = 0;
  double fetched_s_ = 0;
  double last_merge_s_ = 0;
  double merge_cost_s_ = 0;
  double last_progress_s_ = 0;
};

}  // namespace mapweld::serve
