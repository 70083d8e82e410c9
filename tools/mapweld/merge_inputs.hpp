// SPDX-License-Identifier: Apache-2.0
// Everything that `mapweld merge` was given, as drives with submaps: folders of scans and logs of agents, side by side.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/io/tum.hpp"
#include "tools/mapweld/terminal_progress.hpp"
#include "tools/merge/recording.hpp"

namespace mapweld::merge {

class MergeInputs final : public SubmapSource {
 public:
  // Opens every input before any long work begins, so that a mistake is told at once. Throws std::runtime_error naming
  // the input.
  MergeInputs(const std::vector<std::filesystem::path>& paths, int threads, TerminalProgress* progress);

  // By name: the order on the command line must not matter.
  [[nodiscard]] const std::vector<Drive>& drives() const { return drives_; }
  std::shared_ptr<const SubmapCloud> Find(SubmapKey key) override;
  // Per drive, one merged pose for every scan; empty for a log, which has keyframes only.
  [[nodiscard]] std::vector<std::vector<io::StampedPose>> Trajectories(
      const std::vector<std::vector<geom::Pose3>>& merged_T_body) const;

 private:
  // One drive before it is worked on.
  struct Input {
    std::string name;
    std::function<Drive()> build;
    std::function<std::shared_ptr<const SubmapCloud>(int keyframe)> submap;
    std::function<std::vector<io::StampedPose>(const std::vector<geom::Pose3>&)> trajectory;
  };
  [[nodiscard]] Input OpenFolder(const std::string& name, const std::filesystem::path& path, int threads,
                                 TerminalProgress* progress) const;
  void OpenLog(const std::filesystem::path& path);

  std::vector<Input> inputs_;
  std::vector<Drive> drives_;
};

}  // namespace mapweld::merge
