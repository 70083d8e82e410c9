// SPDX-License-Identifier: Apache-2.0
#include "tools/mapweld/merge_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "tools/io/recording_folder.hpp"
#include "tools/io/unique_names.hpp"
#include "tools/mapweld/terminal_progress.hpp"
#include "tools/merge/merge_pipeline.hpp"
#include "tools/merge/recording.hpp"
#include "tools/report/outcome.hpp"

namespace mapweld::merge {
namespace {

struct MergeArguments {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out;
  std::vector<std::string> truth;
  int threads = 0;
};

// Opens every recording before any long work begins, so that a mistake is told at once. By name: the order on the
// command line must not matter.
std::vector<Recording> OpenRecordings(const std::vector<std::filesystem::path>& folders) {
  const std::vector<std::string> names = io::UniqueNames(folders);
  std::vector<Recording> recordings;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const auto folder = std::make_shared<io::RecordingFolder>(io::RecordingFolder::Open(folders[i]));
    for (const std::string& note : folder->notes()) fmt::print(stderr, "merge: {}\n", note);
    recordings.push_back({names[i], folder->times(), folder->world_T_lidar(),
                          [folder](int scan) { return folder->LoadScan(static_cast<std::size_t>(scan)).points; }});
  }
  std::sort(recordings.begin(), recordings.end(),
            [](const Recording& a, const Recording& b) { return a.name < b.name; });
  return recordings;
}

std::vector<io::StampedPose> ScanTrajectory(const Recording& recording, const RecordedDrive& recorded,
                                            const std::vector<geom::Pose3>& merged_T_body) {
  const std::vector<geom::Pose3> poses = MergedScanPoses(recorded, merged_T_body);
  std::vector<io::StampedPose> trajectory;
  for (std::size_t i = 0; i < poses.size(); ++i) trajectory.push_back({recording.times[i], poses[i]});
  return trajectory;
}

void RunMerge(const MergeArguments& arguments) {
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  };
  std::map<std::string, std::filesystem::path> truth;
  for (const std::string& argument : arguments.truth) truth.insert(report::ParseTruth(argument));
  const std::vector<Recording> recordings = OpenRecordings(arguments.folders);

  TerminalProgress progress("merge");
  const auto begin = Clock::now();
  RecordingConfig recording_config;
  recording_config.threads = arguments.threads;
  std::vector<RecordedDrive> recorded;
  std::vector<Drive> drives;
  for (const Recording& recording : recordings) {
    progress.SetSubject(recording.name);
    recorded.push_back(BuildDrive(recording, recording_config, &progress));
    drives.push_back(recorded.back().drive);
  }
  progress.SetSubject("");
  const double build_s = seconds_since(begin);

  MergeConfig config;
  config.threads = arguments.threads;
  RecordedSubmaps submaps(recorded);
  const MergeResult result = MergeDrives(drives, submaps, config, &progress);

  report::OutcomeInput outcome;
  outcome.title = fmt::format("Map of {} recordings", drives.size());
  outcome.drives = &drives;
  outcome.result = &result;
  outcome.submaps = &submaps;
  outcome.truth = std::move(truth);
  outcome.seconds = {{"submaps", build_s}};
  for (std::size_t d = 0; d < drives.size(); ++d) {
    outcome.trajectories.push_back(ScanTrajectory(recordings[d], recorded[d], result.merged_T_body[d]));
  }
  progress.Finish();
  const report::Summary summary = report::WriteOutcome(arguments.out, std::move(outcome));
  fmt::print("{}report: {}\n", report::SummaryTable(summary), (arguments.out / "report.html").string());
}

}  // namespace

void AddMergeCommand(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("merge", "Merge recordings of any LiDAR odometry: scans with poses");
  const auto arguments = std::make_shared<MergeArguments>();
  command
      ->add_option("recordings", arguments->folders, "folders: KITTI layout, or PCD/PLY clouds with a TUM trajectory")
      ->required();
  command->add_option("-o,--out", arguments->out, "folder for map, trajectories and report.html")->required();
  command->add_option("--truth", arguments->truth,
                      "NAME=FILE: true trajectory of a recording, for the errors in the report");
  command->add_option("--threads", arguments->threads, "0: all of the machine; never changes the result")
      ->check(CLI::Range(0, 1024));
  command->callback([arguments] { RunMerge(*arguments); });
}

}  // namespace mapweld::merge
