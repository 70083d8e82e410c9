// SPDX-License-Identifier: Apache-2.0
// The result of a merge as one HTML page that needs nothing else: no network, no scripts, pictures inside.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/merge/drive.hpp"
#include "tools/merge/merge_result.hpp"
#include "tools/report/merged_map.hpp"

namespace mapweld::report {

struct ReportInput {
  std::string title = "Merged map";
  // Not copied; must outlive the call. `result` and `maps` (per group, from BuildGroupMap) belong to `drives`.
  const std::vector<merge::Drive>* drives = nullptr;
  const merge::MergeResult* result = nullptr;
  const std::vector<std::vector<MapPoint>>* maps = nullptr;
  // What is known besides; all may stay empty.
  std::vector<std::optional<double>> drive_rmse_m;  // per drive, after one alignment of its whole group to the truth
  std::vector<std::optional<double>> group_rmse_m;  // per group
  std::vector<std::uint64_t> drive_bytes;           // per drive, what it sent over the air
  std::string footnote;                             // a last line: version, command, data set
};

// The same input gives the same bytes. The file is put in place whole; throws one sentence when it cannot be written.
// Pictures cost most: about 0.1 s per million points. A group's picture is about 0.3 MB.
void WriteReport(const std::filesystem::path& html, const ReportInput& input);

// The page as text.
std::string ReportHtml(const ReportInput& input);

}  // namespace mapweld::report
