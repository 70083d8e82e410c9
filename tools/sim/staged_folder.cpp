// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/staged_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace mapweld::sim {

namespace fs = std::filesystem;

StagedFolder::StagedFolder(fs::path target, const char* marker) : target_(std::move(target)) {
  if (target_.filename().empty()) target_ = target_.parent_path();  // "dir/" means "dir"
  if (fs::exists(target_)) {
    const bool ours = fs::is_directory(target_) && (fs::is_empty(target_) || fs::exists(target_ / marker));
    if (!ours) {
      throw std::runtime_error(
          fmt::format("{} exists and is not a recording; choose another folder with -o", target_.string()));
    }
  }
  staging_ = target_.string() + fmt::format(".writing-{}", ::getpid());
  fs::remove_all(staging_);
  fs::create_directories(staging_);
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
}

void StagedFolder::Publish() {
  fs::remove_all(target_);
  fs::rename(staging_, target_);
  staging_.clear();
}

}  // namespace mapweld::sim
