// SPDX-License-Identifier: Apache-2.0
// What `mapweld eval places` is given, made ready to be scored: per descriptor, the keyframes of all sessions in one
// frame with their bytes.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/describe/place_method.hpp"
#include "tools/eval/place_set.hpp"
#include "tools/mapweld/terminal_progress.hpp"

namespace mapweld::eval {

// One descriptor on one set of keyframes.
struct PlaceTask {
  std::string variant;
  std::shared_ptr<const PlaceSet> set;
  std::shared_ptr<const describe::PlaceMethod> method;
  std::vector<describe::PlaceMethod::Features> features;  // per keyframe; empty: it has no descriptor
  int refused = 0;                                        // keyframes without one
  std::optional<int> unfamiliar;                          // keyframes unlike what the descriptor was trained on
};

struct PlaceArguments {
  // Each a table of `mapweld describe` ([NAME=]FILE.csv), a folder with scans and poses, or an LCM log of agents.
  std::vector<std::string> inputs;
  std::vector<std::string> variants;   // for folders and logs; none: all there are
  std::filesystem::path truth_folder;  // NAME.tum of each folder or log; replaces its own positions
  int threads = 0;
};

// One task per variant, then one per name of a table; tables of one name are sessions of one set. Throws
// std::runtime_error that names the input.
std::vector<PlaceTask> LoadPlaceTasks(const PlaceArguments& arguments, merge::TerminalProgress* progress);

}  // namespace mapweld::eval
