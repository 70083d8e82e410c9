// SPDX-License-Identifier: Apache-2.0
// Everything that `mapweld merge` was given: folders of scans and logs of agents, side by side.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/mapweld/terminal_progress.hpp"
#include "tools/merge/recording.hpp"
#include "tools/store/record_codec.hpp"

namespace mapweld::merge {

// One drive after the work on its scans.
struct BuiltDrive {
  Drive drive;
  store::ScanTrajectory scans;  // empty for a log, which has keyframes only
  std::function<std::shared_ptr<const SubmapCloud>(int keyframe)> submap;
  std::function<store::Bytes(int keyframe)> encoded_submap;  // for a store; empty when there is none
};

// One drive before.
struct MergeInput {
  std::string name;
  std::uint64_t fingerprint = 0;  // of the times and poses that it was opened with
  std::function<BuiltDrive()> build;
};

// Opens every input before any long work begins, so that a mistake is told at once. By name: the order on the command
// line must not matter. Throws std::runtime_error naming the input. progress must outlive the inputs.
std::vector<MergeInput> OpenInputs(const std::vector<std::filesystem::path>& paths, int threads,
                                   TerminalProgress* progress);

}  // namespace mapweld::merge
