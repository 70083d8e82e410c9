// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/odometry_command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/io/atomic_file.hpp"
#include "tools/odometry/drive_player.hpp"
#include "tools/odometry/odometry_map.hpp"
#include "tools/odometry/odometry_report.hpp"
#include "tools/odometry/odometry_run.hpp"
#include "tools/odometry/scan_export.hpp"
#include "tools/odometry/sensor_faults.hpp"
#include "tools/odometry/submap_agreement.hpp"

namespace mapweld::odometry {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  fs::path recording;
  fs::path against;
  fs::path out;
  fs::path json;
  fs::path map;
  fs::path scans;
  std::vector<std::string> faults;
  Sweep sweep = Sweep::kNone;
  bool keep_moving = false;
  bool indoor = false;
};

std::vector<Fault> ParseFaults(const std::vector<std::string>& texts) {
  std::vector<Fault> faults;
  for (const std::string& text : texts) faults.push_back(ParseFault(text));
  return faults;
}

std::vector<io::StampedPose> TruthOf(const fs::path& drive) {
  return fs::exists(drive / "truth.tum") ? io::ReadTum(drive / "truth.tum") : std::vector<io::StampedPose>{};
}

void Finish(const Arguments& arguments, const OdometryRun& run, const std::vector<io::StampedPose>& truth) {
  fmt::print("{}", Report(run, truth));
  if (!arguments.out.empty()) io::WriteTum(arguments.out, Trajectory(run));
  if (!arguments.json.empty()) io::WriteFileAtomically(arguments.json, ReportJson(run, truth));
  if (!arguments.map.empty()) io::WriteFileAtomically(arguments.map, MapPng(run));
}

void ExportScans(const Arguments& arguments, const std::vector<Fault>& faults, const geom::Pose3& body_T_lidar) {
  const std::vector<io::StampedPose> truth = TruthOf(arguments.recording);
  if (truth.empty()) {
    throw std::runtime_error(fmt::format("{} has no truth.tum, which --export-scans needs to undistort the scans",
                                         arguments.recording.string()));
  }
  ScanExport folder(arguments.scans);
  TrueScans scans(truth, body_T_lidar, [&folder](const TrueScan& scan) { folder.Write(scan); });
  PlayDrive(arguments.recording, MakeFaults(faults, &scans).get());
  scans.Flush();
  fmt::print("{}: {} scans\n", arguments.scans.string(), folder.Finish());
}

void RunOnDrive(const Arguments& arguments) {
  const std::vector<Fault> faults = ParseFaults(arguments.faults);
  pipeline::AgentConfig config;
  if (arguments.indoor) pipeline::UseIndoors(&config);
  if (!arguments.scans.empty()) return ExportScans(arguments, faults, config.lio.body_T_lidar);
  const std::vector<io::StampedPose> truth = TruthOf(arguments.recording);
  pipeline::AgentConfig first = config;
  if (arguments.keep_moving) first.submap.max_through_share = 2;
  const OdometryRun run =
      RunDrive(arguments.recording, first, [&](SensorSink* sink) { return MakeFaults(faults, sink); });
  Finish(arguments, run, truth);
  if (arguments.against.empty()) return;
  const OdometryRun other = RunDrive(arguments.against, config, nullptr);
  fmt::print("{}", Report(CompareSubmaps(PlaceSubmaps(run, truth), PlaceSubmaps(other, TruthOf(arguments.against)))));
}

void RunOnClouds(const Arguments& arguments) {
  if (!arguments.map.empty()) {
    throw std::runtime_error(
        "--map draws the submaps of a drive (lidar.pcap, imu.candump); a folder of clouds has none");
  }
  const io::RecordingFolder folder = io::RecordingFolder::Open(arguments.recording);
  for (const std::string& note : folder.notes()) fmt::print(stderr, "odometry: {}\n", note);
  lio::LioConfig config;
  config.use_imu = false;
  config.body_T_lidar = {};
  std::vector<io::StampedPose> reference;
  for (std::size_t i = 0; i < folder.size(); ++i) reference.push_back({folder.times()[i], folder.world_T_lidar()[i]});
  Finish(arguments, RunClouds(folder, config, arguments.sweep), reference);
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
  command->add_option(
      "--against", arguments->against,
      "Then run on this drive too and tell how far the submaps of both agree; faults are left out here");
  command->add_flag("--keep-moving", arguments->keep_moving, "Do not vote on what moved (not for --against)");
  command->add_flag("--indoor", arguments->indoor, "Submaps of 20 m instead of 50 m");
  command->add_option("--json", arguments->json, "Write the figures and the time of every scan here");
  command->add_option("--map", arguments->map, "Draw the drive's submaps where the odometry puts them (PNG)");
  command->add_option("--export-scans", arguments->scans,
                      "Only write the drive's scans, undistorted by the truth, as a KITTI folder for other programs");
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
