// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace mapweld::fuzz {

// Every file of the folder, by name; nothing when there is no such folder.
std::vector<Bytes> ReadFolder(const std::filesystem::path& folder);

// `NAME --write DIR [CORPUS...]` in argv: writes Seeds() and the corpus folders to DIR, and true.
bool WroteSeeds(int argc, char** argv);

}  // namespace mapweld::fuzz
