// SPDX-License-Identifier: Apache-2.0
// Everything a merge leaves behind, in one call: map, trajectories, pose graph, decisions, report.html, summary.json.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/io/tum.hpp"
#include "tools/merge/drive.hpp"
#include "tools/merge/merge_result.hpp"
#include "tools/report/summary.hpp"

namespace mapweld::report {

struct OutcomeInput {
  std::string title;
  const std::vector<merge::Drive>* drives = nullptr;  // must outlive the call, like the next two
  const merge::MergeResult* result = nullptr;
  merge::SubmapSource* submaps = nullptr;                  // those that make the map
  std::vector<std::vector<io::StampedPose>> trajectories;  // per drive; empty: its keyframes
  std::map<std::string, std::filesystem::path> truth;      // per drive name, TUM or KITTI rows; may be empty
  std::vector<DriveSummary> traffic;      // per drive: what it sent and its heap calls, if known; may be empty
  std::vector<merge::StageTime> seconds;  // of the stages around the merge, put before its own
  std::string footnote;
};

// Parses "NAME=FILE". Throws one sentence for anything else.
std::pair<std::string, std::filesystem::path> ParseTruth(const std::string& argument);

// Writes into `folder` (see tools/report/map_writer.hpp, plus report.html and summary.json) and gives the summary.
// Throws one sentence when a file cannot be read or written.
Summary WriteOutcome(const std::filesystem::path& folder, OutcomeInput input);

}  // namespace mapweld::report
