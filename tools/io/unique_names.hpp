// SPDX-License-Identifier: Apache-2.0
// Names for recordings, from their folders.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mapweld::io {

// One name per folder, all different: the folder's own name; where two share it, with the parent's name in front
// (monday_run1, tuesday_run1); where that is not enough, with a number behind (run1_2). Deterministic in the order
// given.
std::vector<std::string> UniqueNames(const std::vector<std::filesystem::path>& folders);

// File names for things that have names: slashes, blanks and control characters become underscores, doubles get
// numbers.
std::vector<std::string> UniqueFileNames(const std::vector<std::string>& names);

}  // namespace mapweld::io
