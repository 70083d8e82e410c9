// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/eval_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/eval/arrivals_command.hpp"
#include "tools/eval/growth_command.hpp"
#include "tools/eval/merge_score.hpp"
#include "tools/eval/places_command.hpp"
#include "tools/eval/viewpoint_command.hpp"
#include "tools/io/trajectory_file.hpp"
#include "tools/io/unique_names.hpp"

namespace mapweld::eval {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Lines of a KITTI file stand for times one tenth of a second apart; any step does, as both files take the same.
std::vector<io::StampedPose> Stamped(const io::Trajectory& trajectory) {
  std::vector<io::StampedPose> stamped;
  for (std::size_t i = 0; i < trajectory.world_T_lidar.size(); ++i) {
    const TimeNs t =
        trajectory.times.empty() ? TimeNs{static_cast<std::int64_t>(i) * 100'000'000} : trajectory.times[i];
    stamped.push_back({t, trajectory.world_T_lidar[i]});
  }
  return stamped;
}

Json StatisticsJson(const ErrorStatistics& s) {
  return {{"poses", s.count}, {"rmse_m", s.rmse_m}, {"mean_m", s.mean_m}, {"median_m", s.median_m}, {"max_m", s.max_m}};
}

}  // namespace

std::vector<Vehicle> LoadVehicles(const std::vector<fs::path>& truth, const std::vector<fs::path>& estimate) {
  if (truth.size() != estimate.size()) {
    throw std::runtime_error(
        fmt::format("{} --truth and {} --estimate; give one truth for each estimate, in the same "
                    "order",
                    truth.size(), estimate.size()));
  }
  std::vector<fs::path> without_extension = estimate;
  for (fs::path& path : without_extension) path.replace_extension();
  const std::vector<std::string> names = io::UniqueNames(without_extension);
  std::vector<Vehicle> group;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const io::Trajectory t = io::ReadTrajectory(truth[i], io::PoseUse::kPositions);
    const io::Trajectory e = io::ReadTrajectory(estimate[i], io::PoseUse::kPositions);
    const bool by_line = t.times.empty() && e.times.empty();
    if (t.times.empty() != e.times.empty()) {
      throw std::runtime_error(fmt::format("{} has times and {} has none; give both as TUM or both as KITTI rows",
                                           (t.times.empty() ? e : t).path.string(),
                                           (t.times.empty() ? t : e).path.string()));
    }
    if (by_line && t.world_T_lidar.size() != e.world_T_lidar.size()) {
      throw std::runtime_error(fmt::format("{} has {} poses and {} has {}; rows without times must match one to one",
                                           truth[i].string(), t.world_T_lidar.size(), estimate[i].string(),
                                           e.world_T_lidar.size()));
    }
    group.push_back({names[i], Stamped(t), Stamped(e)});
  }
  return group;
}

std::string ErrorTable(const GroupError& error) {
  std::size_t width = std::string_view("vehicle").size();
  for (const VehicleError& vehicle : error.vehicles) width = std::max(width, vehicle.name.size());
  const auto row = [&](const std::string& name, const ErrorStatistics& s) {
    return fmt::format("{:<{}} {:>8} {:>10.3f} {:>10.3f} {:>10.3f} {:>10.3f}", name, width, s.count, s.rmse_m, s.mean_m,
                       s.median_m, s.max_m);
  };
  std::string table =
      fmt::format("{:<{}} {:>8} {:>10} {:>10} {:>10} {:>10} {:>11} {:>9} {:>9} {:>9}\n", "vehicle", width, "poses",
                  "rmse (m)", "mean (m)", "median (m)", "max (m)", "alone (m)", "RPE (m)", "RPE (deg)", "drift (%)");
  for (const VehicleError& vehicle : error.vehicles) {
    const auto number = [](std::size_t of, double value) { return of > 0 ? fmt::format("{:.3f}", value) : "-"; };
    table += row(vehicle.name, vehicle.together) +
             fmt::format(" {:>11.3f} {:>9} {:>9} {:>9}\n", vehicle.alone.rmse_m,
                         number(vehicle.step.steps, vehicle.step.translation_m),
                         number(vehicle.step.steps, vehicle.step.rotation_deg),
                         number(vehicle.drift.segments, vehicle.drift.translation_percent));
  }
  table += row("all", error.all) + '\n';
  table +=
      "Errors of position after one SE(3) alignment common to all vehicles; alone: rmse after an alignment of its "
      "own.\nRPE: rms error of the motion over 10 m of path. drift: mean over KITTI's segments of 100 to 800 m.\n";
  for (const VehicleError& vehicle : error.vehicles) {
    if (vehicle.unmatched == 0) continue;
    table +=
        fmt::format("{}: {} poses have no truth at their time and are left out.\n", vehicle.name, vehicle.unmatched);
  }
  return table;
}

std::string ErrorJson(const GroupError& error) {
  Json vehicles = Json::array();
  for (const VehicleError& vehicle : error.vehicles) {
    vehicles.push_back({{"name", vehicle.name},
                        {"together", StatisticsJson(vehicle.together)},
                        {"alone", StatisticsJson(vehicle.alone)},
                        {"relative_pose_error",
                         {{"steps", vehicle.step.steps},
                          {"translation_m", vehicle.step.translation_m},
                          {"rotation_deg", vehicle.step.rotation_deg}}},
                        {"kitti_drift",
                         {{"segments", vehicle.drift.segments},
                          {"translation_percent", vehicle.drift.translation_percent},
                          {"rotation_deg_per_m", vehicle.drift.rotation_deg_per_m}}},
                        {"unmatched", vehicle.unmatched}});
  }
  const geom::Pose3& pose = error.truth_T_estimate;
  const Json alignment = {{"t", {pose.t.x(), pose.t.y(), pose.t.z()}},
                          {"q_xyzw", {pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w()}}};
  const Json json = {{"all", StatisticsJson(error.all)}, {"vehicles", vehicles}, {"truth_T_estimate", alignment}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

namespace {

void AddTrajectories(CLI::App& eval) {
  struct Options {
    std::vector<fs::path> truth;
    std::vector<fs::path> estimate;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = eval.add_subcommand("trajectories", "absolute trajectory error of one or several vehicles");
  command->add_option("--truth", options->truth, "true trajectory, TUM or KITTI rows; once per vehicle")->required();
  command->add_option("--estimate", options->estimate, "estimated trajectory; once per vehicle, same order")
      ->required();
  command->add_flag("--json", options->json, "print JSON instead of a table");
  command->callback([options] {
    const GroupError error = EvaluateGroup(LoadVehicles(options->truth, options->estimate));
    fmt::print("{}", options->json ? ErrorJson(error) : ErrorTable(error));
  });
}

void AddMerge(CLI::App& eval) {
  struct Options {
    fs::path result;
    fs::path truth;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = eval.add_subcommand("merge", "which overlaps and groups a merge of simulated drives got right");
  command->add_option("result", options->result, "output folder of mapweld merge or serve")->required();
  command->add_option("--truth", options->truth, "scenario.json of mapweld sim")->required();
  command->add_flag("--json", options->json, "print JSON instead of a table");
  command->callback([options] {
    const MergeScore score = ScoreMerge(ReadMergeTruth(options->truth), ReadMergeOutcome(options->result));
    fmt::print("{}", options->json ? ScoreJson(score) : ScoreTable(score));
  });
}

}  // namespace

void AddEvalCommand(CLI::App& app) {
  CLI::App* eval = app.add_subcommand("eval", "Measure results against the truth");
  eval->require_subcommand(1);
  AddTrajectories(*eval);
  AddMerge(*eval);
  AddArrivalsCommand(*eval);
  AddGrowthCommand(*eval);
  AddPlacesCommand(*eval);
  AddViewpointCommand(*eval);
}

}  // namespace mapweld::eval
