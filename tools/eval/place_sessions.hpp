// SPDX-License-Identifier: Apache-2.0
// The recordings and logs that places are measured on, one after the other, with their true positions.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/describe/keyframe_source.hpp"
#include "tools/mapweld/terminal_progress.hpp"

namespace mapweld::eval {

struct SessionArguments {
  std::vector<std::string> inputs;              // folders with scans and poses, and LCM logs of agents
  std::filesystem::path truth_folder;           // NAME.tum of each; empty: their own positions, in one frame
  double radius_m = describe::kSubmapRadius_m;  // of submaps made from scans
  int threads = 0;
};

// Only one session is in memory at a time. Keyframes at times without truth are left out, and said. Throws
// std::runtime_error that names the input; so for several logs without truth, each of which has a frame of its own.
void ForEachSession(const SessionArguments& arguments, merge::TerminalProgress* progress,
                    const std::function<void(describe::KeyframeSource)>& visit);

}  // namespace mapweld::eval
