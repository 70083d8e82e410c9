// SPDX-License-Identifier: Apache-2.0
#include "tools/mapweld/merge_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/io/recording_folder.hpp"
#include "tools/io/unique_names.hpp"
#include "tools/serve/agent_log.hpp"
#include "tools/store/hash.hpp"

namespace mapweld::merge {
namespace {

MergeInput OpenFolder(const std::string& name, const std::filesystem::path& path, int threads,
                      TerminalProgress* progress) {
  const auto folder = std::make_shared<io::RecordingFolder>(io::RecordingFolder::Open(path));
  for (const std::string& note : folder->notes()) fmt::print(stderr, "merge: {}\n", note);
  MergeInput input;
  input.name = name;
  input.fingerprint = store::Hash(store::Encode(store::ScanTrajectory{folder->times(), folder->world_T_lidar(), {}}));
  input.build = [name, folder, threads, progress] {
    progress->SetSubject(name);
    const Recording recording{name, folder->times(), folder->world_T_lidar(),
                              [folder](int scan) { return folder->LoadScan(static_cast<std::size_t>(scan)).points; }};
    RecordingConfig config;
    config.threads = threads;
    const auto recorded = std::make_shared<RecordedDrive>(BuildDrive(recording, config, progress));
    BuiltDrive built;
    built.drive = recorded->drive;
    built.scans = {recording.times, recorded->odom_T_scan, recorded->scan_path_m};
    built.submap = [recorded](int keyframe) -> std::shared_ptr<const SubmapCloud> {
      const auto k = static_cast<std::size_t>(keyframe);
      return k < recorded->submaps.size() ? Kept(&recorded->submaps[k]) : nullptr;
    };
    built.encoded_submap = [recorded](int keyframe) {
      return store::Encode(recorded->submaps[static_cast<std::size_t>(keyframe)]);
    };
    return built;
  };
  return input;
}

void OpenLog(const std::filesystem::path& path, std::vector<MergeInput>* inputs) {
  const auto log = std::make_shared<serve::AgentLog>(path);
  if (log->refused() > 0) {
    fmt::print(stderr, "merge: {}: {} broken messages passed over\n", path.string(), log->refused());
  }
  for (std::size_t d = 0; d < log->drives().size(); ++d) {
    MergeInput input;
    input.name = log->drives()[d].name;
    input.fingerprint = store::kHashSeed;
    for (const Keyframe& keyframe : log->drives()[d].keyframes) {
      input.fingerprint = store::Hash(store::Encode(keyframe), input.fingerprint);
    }
    input.build = [log, d] {
      BuiltDrive built;
      built.drive = log->drives()[d];
      built.submap = [log, d](int keyframe) { return log->Submap(d, keyframe); };
      built.encoded_submap = [log, d](int keyframe) {
        const auto whole = log->Whole(d, keyframe);
        return whole.has_value() ? store::EncodedByAgent(whole->encoded) : store::Bytes{};
      };
      return built;
    };
    inputs->push_back(std::move(input));
  }
}

}  // namespace

std::vector<MergeInput> OpenInputs(const std::vector<std::filesystem::path>& paths, int threads,
                                   TerminalProgress* progress) {
  std::vector<MergeInput> inputs;
  std::vector<std::filesystem::path> folders;
  for (const std::filesystem::path& path : paths) {
    path.extension() == ".lcm" ? OpenLog(path, &inputs) : folders.push_back(path);
  }
  const std::vector<std::string> names = io::UniqueNames(folders);
  for (std::size_t i = 0; i < folders.size(); ++i) {
    inputs.push_back(OpenFolder(names[i], folders[i], threads, progress));
  }
  std::stable_sort(inputs.begin(), inputs.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return inputs;
}

}  // namespace mapweld::merge
