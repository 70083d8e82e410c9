// SPDX-License-Identifier: Apache-2.0
#include "tools/report/outcome.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "tools/eval/trajectory_error.hpp"
#include "tools/io/atomic_file.hpp"
#include "tools/io/trajectory_file.hpp"
#include "tools/report/map_writer.hpp"
#include "tools/report/merged_map.hpp"
#include "tools/report/report.hpp"

namespace mapweld::report {
namespace {

struct Errors {
  std::vector<std::optional<double>> drive_rmse_m;
  std::vector<std::optional<double>> group_rmse_m;
  std::optional<double> all_m;
};

std::vector<io::StampedPose> Estimate(const OutcomeInput& input, std::size_t drive) {
  if (drive < input.trajectories.size() && !input.trajectories[drive].empty()) return input.trajectories[drive];
  std::vector<io::StampedPose> poses;
  const auto& keyframes = (*input.drives)[drive].keyframes;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    poses.push_back({keyframes[k].t, input.result->merged_T_body[drive][k]});
  }
  return poses;
}

// Truth that has no times of its own (KITTI rows) belongs to the estimate row by row.
std::vector<io::StampedPose> ReadTruth(const std::filesystem::path& path,
                                       const std::vector<io::StampedPose>& estimate) {
  const io::Trajectory file = io::ReadTrajectory(path, io::PoseUse::kPositions);
  if (file.times.empty() && file.world_T_lidar.size() != estimate.size()) {
    throw std::runtime_error(
        fmt::format("{} has {} rows and no times, the estimate has {} poses; give the truth with "
                    "times (TUM)",
                    path.string(), file.world_T_lidar.size(), estimate.size()));
  }
  std::vector<io::StampedPose> truth;
  for (std::size_t i = 0; i < file.world_T_lidar.size(); ++i) {
    truth.push_back({file.times.empty() ? estimate[i].t : file.times[i], file.world_T_lidar[i]});
  }
  return truth;
}

// Each group is aligned to the truth by one rigid transform.
Errors Evaluate(const OutcomeInput& input) {
  Errors errors;
  errors.drive_rmse_m.resize(input.drives->size());
  errors.group_rmse_m.resize(input.result->groups.size());
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t g = 0; g < input.result->groups.size(); ++g) {
    std::vector<eval::Vehicle> vehicles;
    std::vector<std::size_t> members;
    for (const int drive : input.result->groups[g]) {
      const auto d = static_cast<std::size_t>(drive);
      const auto truth = input.truth.find((*input.drives)[d].name);
      if (truth == input.truth.end()) continue;
      const auto estimate = Estimate(input, d);
      vehicles.push_back({truth->first, ReadTruth(truth->second, estimate), estimate});
      members.push_back(d);
    }
    if (vehicles.empty()) continue;
    const eval::GroupError error = eval::EvaluateGroup(vehicles);
    for (std::size_t i = 0; i < members.size(); ++i)
      errors.drive_rmse_m[members[i]] = error.vehicles[i].together.rmse_m;
    errors.group_rmse_m[g] = error.all.rmse_m;
    squares += error.all.rmse_m * error.all.rmse_m * static_cast<double>(error.all.count);
    count += error.all.count;
  }
  if (count > 0) errors.all_m = std::sqrt(squares / static_cast<double>(count));
  return errors;
}

Summary Summarise(const OutcomeInput& input, const Errors& errors) {
  Summary summary;
  for (std::size_t d = 0; d < input.drives->size(); ++d) {
    const merge::Drive& drive = (*input.drives)[d];
    DriveSummary row = d < input.traffic.size() ? input.traffic[d] : DriveSummary{};
    row.name = drive.name;
    row.group = input.result->group_of[d] + 1;
    row.keyframes = static_cast<int>(drive.keyframes.size());
    row.path_m = drive.keyframes.empty() ? 0 : drive.keyframes.back().path_m;
    row.rmse_m = errors.drive_rmse_m[d];
    summary.drives.push_back(row);
  }
  summary.groups = static_cast<int>(input.result->groups.size());
  summary.rmse_all_m = errors.all_m;
  summary.group_rmse_m = errors.group_rmse_m;
  for (const merge::Overlap& overlap : input.result->overlaps) {
    ++(overlap.accepted ? summary.overlaps_accepted : summary.overlaps_rejected);
  }
  summary.seconds = input.seconds;
  for (const merge::StageTime& time : input.result->times) summary.seconds.push_back(time);
  return summary;
}

}  // namespace

std::pair<std::string, std::filesystem::path> ParseTruth(const std::string& argument) {
  const auto equals = argument.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == argument.size()) {
    throw std::runtime_error(fmt::format("--truth '{}' is not NAME=FILE, for example agent_1=truth.tum", argument));
  }
  return {argument.substr(0, equals), argument.substr(equals + 1)};
}

Summary WriteOutcome(const std::filesystem::path& folder, OutcomeInput input) {
  const auto begin = std::chrono::steady_clock::now();
  const Errors errors = Evaluate(input);
  std::vector<std::vector<MapPoint>> maps;
  for (std::size_t g = 0; g < input.result->groups.size(); ++g) {
    maps.push_back(BuildGroupMap(*input.drives, *input.result, static_cast<int>(g), input.submaps));
  }
  WriteMergeOutput(folder, *input.drives, *input.result, maps, input.trajectories);

  ReportInput report;
  report.title = input.title;
  report.drives = input.drives;
  report.result = input.result;
  report.maps = &maps;
  report.drive_rmse_m = errors.drive_rmse_m;
  report.group_rmse_m = errors.group_rmse_m;
  report.footnote = input.footnote;
  for (const DriveSummary& row : input.traffic) {
    report.drive_bytes.push_back(static_cast<std::uint64_t>(row.bytes_sent.value_or(0)));
  }
  WriteReport(folder / "report.html", report);

  Summary summary = Summarise(input, errors);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  summary.seconds.push_back({"output", took.count()});
  io::WriteFileAtomically(folder / "summary.json", SummaryJson(summary));
  return summary;
}

}  // namespace mapweld::report
