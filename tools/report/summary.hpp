// SPDX-License-Identifier: Apache-2.0
// The outcome of a merge in a few numbers: as summary.json for programs and as a table for people.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/merge/merge_result.hpp"

namespace mapweld::report {

struct DriveSummary {
  std::string name;
  int group = 0;  // counted from 1
  double path_m = 0;
  int keyframes = 0;
  std::optional<double> rmse_m;            // against the truth, aligned together with the rest of its group
  std::optional<double> bytes_sent;        // all LCM payload
  std::optional<double> keyframe_bytes;    // of these, keyframe_t
  std::optional<double> submap_bytes;      // of these, submap_chunk_t
  std::optional<std::int64_t> heap_calls;  // of the agent after boot
};

struct Summary {
  std::vector<DriveSummary> drives;
  int groups = 0;
  std::vector<std::optional<double>> group_rmse_m;  // per group, after one alignment of the whole group to the truth
  std::optional<double> rmse_all_m;  // over all drives with truth, each group aligned by one rigid transform
  int overlaps_accepted = 0;
  int overlaps_rejected = 0;
  std::vector<merge::StageTime> seconds;
};

// {"groups": n, "rmse_m": {name: m, "all": m}, "bytes_per_km": {name: n, "all": n}, "heap_calls_after_boot": n,
//  "seconds": {stage: s}, ...}. What is not known is null.
std::string SummaryJson(const Summary& summary);
// One line per drive, one per group of several drives whose truth is known, and the totals.
std::string SummaryTable(const Summary& summary);

}  // namespace mapweld::report
