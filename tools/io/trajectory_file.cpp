// SPDX-License-Identifier: Apache-2.0
#include "tools/io/trajectory_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "tools/io/kitti.hpp"
#include "tools/io/text_rows.hpp"

namespace mapweld::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kNames[] = {"poses.txt",      "trajectory.txt", "poses.tum",     "trajectory.tum",
                                       "traj_lidar.txt", "odometry.txt",   "poses_tum.txt", "poses_kitti.txt"};
constexpr std::string_view kEndings[] = {".tum", "_tum.txt", "_kitti.txt"};

}  // namespace

fs::path FindTrajectory(const fs::path& recording) {
  for (const std::string_view name : kNames) {
    if (fs::is_regular_file(recording / name)) return recording / name;
  }
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(recording)) {
    const std::string name = entry.path().filename().string();
    const bool fits = std::any_of(std::begin(kEndings), std::end(kEndings),
                                  [&](std::string_view ending) { return name.ends_with(ending); });
    if (fits && entry.is_regular_file()) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  // Some programs write one trajectory in both formats; TUM sorts behind KITTI and has the times.
  const bool one_in_two_formats =
      found.size() == 2 && found[0].string().ends_with("_kitti.txt") && found[1].string().ends_with("_tum.txt");
  if (found.size() == 1 || one_in_two_formats) return found.back();
  if (found.size() > 1) {
    throw std::runtime_error(fmt::format("{} has several trajectories ({}, {}); rename the one to use to poses.txt",
                                         recording.string(), found[0].filename().string(),
                                         found[1].filename().string()));
  }
  const fs::path full = fs::absolute(recording).lexically_normal();
  const fs::path folder = full.has_filename() ? full : full.parent_path();
  fs::path benchmark = folder.parent_path().parent_path() / "poses" / folder.filename();
  benchmark += ".txt";
  if (fs::is_regular_file(benchmark)) return benchmark;
  throw std::runtime_error(
      fmt::format("no poses in {}; put a poses.txt there (KITTI: 12 numbers per scan, TUM: time x y z qx qy qz qw)",
                  recording.string()));
}

Trajectory ReadTrajectory(const fs::path& path, PoseUse use) {
  std::size_t columns = 0;
  {
    const TextRows file(path);
    if (file.rows().empty()) {
      throw std::runtime_error(fmt::format("{} has no poses; run the odometry again", path.string()));
    }
    const TextRow& row = file.rows().front();
    columns = row.words.size();
    if (columns != 8 && columns != 12) {
      file.Fail(
          row, fmt::format("{} values are no pose; write 12 numbers (KITTI) or time x y z qx qy qz qw (TUM)", columns));
    }
  }
  if (columns == 12) return {path, ReadKittiPoses(path), {}};
  Trajectory trajectory{path, {}, {}};
  for (const StampedPose& row : ReadTum(path, use)) {
    trajectory.times.push_back(row.t);
    trajectory.world_T_lidar.push_back(row.world_T_body);
  }
  return trajectory;
}

}  // namespace mapweld::io
