// SPDX-License-Identifier: Apache-2.0
// A folder that appears under its name only when it is complete.
#pragma once

#include <filesystem>

namespace mapweld::sim {

class StagedFolder {
 public:
  // `marker` is a file that every complete folder holds; a folder at `target` that is not empty and has none belongs to
  // somebody else and is refused with std::runtime_error.
  StagedFolder(std::filesystem::path target, const char* marker);
  ~StagedFolder();  // without Publish(), removes what was written
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return staging_; }
  void Publish();

 private:
  std::filesystem::path target_;
  std::filesystem::path staging_;
};

}  // namespace mapweld::sim
