// SPDX-License-Identifier: Apache-2.0
// Recordings that do not belong in the repository: the folder named by MAPWELD_SHARED_DATA, else ../shared/data beside
// the source tree (MAPWELD_SOURCE_DIR, set by the test's CMakeLists).
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace mapweld::test {

// The file or folder, or nothing: the test then skips and says what is missing.
inline std::optional<std::filesystem::path> SharedData(const std::string& name) {
  const char* root = std::getenv("MAPWELD_SHARED_DATA");
  const std::filesystem::path base = root != nullptr
                                         ? std::filesystem::path(root)
                                         : std::filesystem::path(MAPWELD_SOURCE_DIR) / ".." / "shared" / "data";
  const std::filesystem::path path = base / name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

}  // namespace mapweld::test
