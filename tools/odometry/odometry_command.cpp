// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/odometry_command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/odometry/odometry_report.hpp"
#include "tools/odometry/odometry_run.hpp"
#include "tools/odometry/sensor_faults.hpp"

namespace mapweld::odometry {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  fs::path recording;
  fs::path out;
  std::vector<std::string> faults;
  Sweep sweep = Sweep::kNone;
};

void RunOnDrive(const Arguments& arguments) {
  std::vector<Fault> faults;
  for (const std::string& fault : arguments.faults) faults.push_back(ParseFault(fault));
  const OdometryRun run = RunDrive(arguments.recording, pipeline::AgentConfig{},
                                   [&](SensorSink* sink) { return MakeFaults(faults, sink); });
  const fs::path truth = arguments.recording / "truth.tum";
  fmt::print("{}", Report(run, fs::exists(truth) ? io::ReadTum(truth) : std::vector<io::StampedPose>{}));
  if (!arguments.out.empty()) io::WriteTum(arguments.out, Trajectory(run));
}

void RunOnClouds(const Arguments& arguments) {
  const io::RecordingFolder folder = io::RecordingFolder::Open(arguments.recording);
  for (const std::string& note : folder.notes()) fmt::print(stderr, "odometry: {}\n", note);
  lio::LioConfig config;
  config.use_imu = false;
  config.body_T_lidar = {};
  const OdometryRun run = RunClouds(folder, config, arguments.sweep);
  std::vector<io::StampedPose> reference;
  for (std::size_t i = 0; i < folder.size(); ++i) reference.push_back({folder.times()[i], folder.world_T_lidar()[i]});
  fmt::print("{}", Report(run, reference));
  if (!arguments.out.empty()) io::WriteTum(arguments.out, Trajectory(run));
}

}  // namespace

void AddOdometryCommand(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("odometry", "Run the agent's odometry on a recording and measure it");
  command
      ->add_option("recording", arguments->recording,
                   "A drive (lidar.pcap, imu.candump, truth.tum) or a folder of clouds with poses to compare with")
      ->required();
  command->add_option("-o,--out", arguments->out, "Write the trajectory here (TUM)");
  command->add_option("--fault", arguments->faults, "Spoil the sensors of a drive: NAME:AMOUNT[:SECONDS], repeatable");
  const std::map<std::string, Sweep> sweeps{
      {"none", Sweep::kNone}, {"cw", Sweep::kClockwise}, {"ccw", Sweep::kCounterClockwise}};
  command->add_option("--sweep", arguments->sweep, "How a spinning LiDAR took the clouds: none, cw or ccw from above")
      ->transform(CLI::CheckedTransformer(sweeps));
  command->callback([arguments] {
    try {
      if (fs::exists(arguments->recording / "lidar.pcap")) {
        RunOnDrive(*arguments);
      } else {
        RunOnClouds(*arguments);
      }
    } catch (const std::exception& e) {
      fmt::print(stderr, "mapweld odometry: {}\n", e.what());
      throw CLI::RuntimeError(1);
    }
  });
}

}  // namespace mapweld::odometry
