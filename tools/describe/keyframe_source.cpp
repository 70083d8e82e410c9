// SPDX-License-Identifier: Apache-2.0
#include "tools/describe/keyframe_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "tools/io/recording_folder.hpp"
#include "tools/merge/recording.hpp"
#include "tools/serve/agent_log.hpp"

namespace mapweld::describe {
namespace {

KeyframeSource OpenFolder(const std::filesystem::path& path, double radius_m, int threads, merge::Progress* progress) {
  const io::RecordingFolder folder = io::RecordingFolder::Open(path);
  for (const std::string& note : folder.notes()) fmt::print(stderr, "note: {}\n", note);
  const merge::Recording recording{folder.name(), folder.times(), folder.world_T_lidar(), [&folder](int scan) {
                                     return folder.LoadScan(static_cast<std::size_t>(scan)).points;
                                   }};
  merge::RecordingConfig config;
  config.radius_m = radius_m;
  config.threads = threads;
  const auto recorded = std::make_shared<merge::RecordedDrive>(merge::BuildDrive(recording, config, progress));
  KeyframeSource source;
  source.drive = recorded->drive;
  const geom::Pose3 world_T_odom = recorded->odom_T_world.Inverse();
  for (const merge::Keyframe& keyframe : source.drive.keyframes) {
    const auto scan = std::lower_bound(recording.times.begin(), recording.times.end(), keyframe.t);
    source.scans.push_back(static_cast<int>(scan - recording.times.begin()));
    source.positions.push_back(world_T_odom * keyframe.odom_T_body.t);
  }
  source.submap = [recorded](int k) { return merge::Kept(&recorded->submaps[static_cast<std::size_t>(k)]); };
  return source;
}

std::vector<KeyframeSource> OpenLog(const std::filesystem::path& path) {
  const auto log = std::make_shared<serve::AgentLog>(path);
  if (log->refused() > 0) {
    fmt::print(stderr, "note: {}: {} broken messages passed over\n", path.string(), log->refused());
  }
  std::vector<KeyframeSource> sources(log->drives().size());
  for (std::size_t d = 0; d < sources.size(); ++d) {
    sources[d].drive = log->drives()[d];
    sources[d].submap = [log, d](int k) { return log->Submap(d, k); };
    for (const merge::Keyframe& keyframe : sources[d].drive.keyframes) {
      sources[d].scans.push_back(static_cast<int>(sources[d].scans.size()));
      sources[d].positions.push_back(keyframe.odom_T_body.t);
    }
  }
  return sources;
}

}  // namespace

std::vector<KeyframeSource> OpenKeyframes(const std::filesystem::path& path, double radius_m, int threads,
                                          merge::Progress* progress) {
  if (path.extension() == ".lcm") return OpenLog(path);
  std::vector<KeyframeSource> sources;
  sources.push_back(OpenFolder(path, radius_m, threads, progress));
  return sources;
}

}  // namespace mapweld::describe
