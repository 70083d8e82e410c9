// SPDX-License-Identifier: Apache-2.0
#include "tools/mapweld/merge_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/io/recording_folder.hpp"
#include "tools/io/unique_names.hpp"
#include "tools/serve/agent_log.hpp"

namespace mapweld::merge {

MergeInputs::MergeInputs(const std::vector<std::filesystem::path>& paths, int threads, TerminalProgress* progress) {
  std::vector<std::filesystem::path> folders;
  for (const std::filesystem::path& path : paths) {
    path.extension() == ".lcm" ? OpenLog(path) : folders.push_back(path);
  }
  const std::vector<std::string> names = io::UniqueNames(folders);
  for (std::size_t i = 0; i < folders.size(); ++i) {
    inputs_.push_back(OpenFolder(names[i], folders[i], threads, progress));
  }
  std::stable_sort(inputs_.begin(), inputs_.end(), [](const Input& a, const Input& b) { return a.name < b.name; });
  for (const Input& input : inputs_) {
    progress->SetSubject(input.name);
    drives_.push_back(input.build());
  }
}

MergeInputs::Input MergeInputs::OpenFolder(const std::string& name, const std::filesystem::path& path, int threads,
                                           TerminalProgress* progress) const {
  const auto folder = std::make_shared<io::RecordingFolder>(io::RecordingFolder::Open(path));
  for (const std::string& note : folder->notes()) fmt::print(stderr, "merge: {}\n", note);
  const auto recording =
      std::make_shared<Recording>(Recording{name, folder->times(), folder->world_T_lidar(), [folder](int scan) {
                                              return folder->LoadScan(static_cast<std::size_t>(scan)).points;
                                            }});
  const auto recorded = std::make_shared<RecordedDrive>();
  Input input;
  input.name = name;
  input.build = [recording, recorded, threads, progress] {
    RecordingConfig config;
    config.threads = threads;
    *recorded = BuildDrive(*recording, config, progress);
    return recorded->drive;
  };
  input.submap = [recorded](int keyframe) -> std::shared_ptr<const SubmapCloud> {
    const auto k = static_cast<std::size_t>(keyframe);
    return k < recorded->submaps.size() ? Kept(&recorded->submaps[k]) : nullptr;
  };
  input.trajectory = [recording, recorded](const std::vector<geom::Pose3>& merged_T_body) {
    const std::vector<geom::Pose3> poses = MergedScanPoses(*recorded, merged_T_body);
    std::vector<io::StampedPose> trajectory;
    for (std::size_t i = 0; i < poses.size(); ++i) trajectory.push_back({recording->times[i], poses[i]});
    return trajectory;
  };
  return input;
}

void MergeInputs::OpenLog(const std::filesystem::path& path) {
  const auto log = std::make_shared<serve::AgentLog>(path);
  if (log->refused() > 0) {
    fmt::print(stderr, "merge: {}: {} broken messages passed over\n", path.string(), log->refused());
  }
  for (std::size_t d = 0; d < log->drives().size(); ++d) {
    Input input;
    input.name = log->drives()[d].name;
    input.build = [log, d] { return log->drives()[d]; };
    input.submap = [log, d](int keyframe) { return log->Submap(d, keyframe); };
    input.trajectory = [](const std::vector<geom::Pose3>&) { return std::vector<io::StampedPose>{}; };
    inputs_.push_back(std::move(input));
  }
}

std::shared_ptr<const SubmapCloud> MergeInputs::Find(SubmapKey key) {
  const auto drive = static_cast<std::size_t>(key.drive);
  return drive < inputs_.size() ? inputs_[drive].submap(key.keyframe) : nullptr;
}

std::vector<std::vector<io::StampedPose>> MergeInputs::Trajectories(
    const std::vector<std::vector<geom::Pose3>>& merged_T_body) const {
  std::vector<std::vector<io::StampedPose>> out;
  for (std::size_t d = 0; d < inputs_.size(); ++d) out.push_back(inputs_[d].trajectory(merged_T_body[d]));
  return out;
}

}  // namespace mapweld::merge
