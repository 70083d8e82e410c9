// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/sim_command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <mutex>

#include "tools/sim/scenario.hpp"

namespace mapweld::sim {
namespace {

class ProgressPrinter {
 public:
  void operator()(int vehicle, double share) {
    const std::lock_guard lock(mutex_);
    const int percent = static_cast<int>(share * 100) / 10 * 10;
    int& printed = printed_.try_emplace(vehicle, -1).first->second;
    if (percent == printed) return;
    printed = percent;
    fmt::print(stderr, "vehicle {}: {} %\n", vehicle, percent);
  }

 private:
  std::mutex mutex_;
  std::map<int, int> printed_;
};

void PrintWire(const SimSummary& summary, const std::filesystem::path& out) {
  double all_rays = 0;
  for (const VehicleSummary& v : summary.vehicles) {
    const auto rays = static_cast<double>(v.counts.rays);
    fmt::print("vehicle {}: {:.0f} m in {:.1f} s, {} LiDAR packets ({:.0f} % of the beams return), {} IMU samples\n",
               v.id, v.length_m, v.duration_s, v.counts.packets,
               100 * static_cast<double>(v.counts.returns) / std::max(rays, 1.0), v.counts.imu_samples);
    all_rays += rays;
  }
  fmt::print("{}: {} vehicles, {:.1f} million rays in {:.1f} s ({:.2f} million rays/s), town ready after {:.1f} s\n",
             out.string(), summary.vehicles.size(), all_rays * 1e-6, summary.drive_s, all_rays * 1e-6 / summary.drive_s,
             summary.prepare_s);
}

void PrintClouds(const SimSummary& summary, const std::filesystem::path& out) {
  double length_m = 0;
  std::int64_t clouds = 0;
  for (const VehicleSummary& v : summary.vehicles) {
    length_m += v.length_m;
    clouds += v.clouds;
  }
  fmt::print("{}: {} drives, {:.1f} km, {} scans; {:.0f} s, town ready after {:.1f} s\n", out.string(),
             summary.vehicles.size(), length_m * 1e-3, clouds, summary.drive_s, summary.prepare_s);
}

void PrintSubmaps(const SimSummary& summary, const std::filesystem::path& out) {
  double length_m = 0;
  AgentLogCounts sum;
  for (const VehicleSummary& v : summary.vehicles) {
    length_m += v.length_m;
    sum.scans += v.log.scans;
    sum.keyframes += v.log.keyframes;
    sum.submap_bytes += v.log.submap_bytes;
  }
  fmt::print(
      "{}: {} drives, {:.1f} km, {} overlapping pairs, {} keyframes, {} scans, {:.1f} kB per submap; {:.0f} s, "
      "town ready after {:.1f} s\n",
      out.string(), summary.vehicles.size(), length_m * 1e-3, summary.overlaps, sum.keyframes, sum.scans,
      static_cast<double>(sum.submap_bytes) * 1e-3 / static_cast<double>(std::max<std::int64_t>(sum.keyframes, 1)),
      summary.drive_s, summary.prepare_s);
}

}  // namespace

int RunSim(const SimOptions& options) {
  try {
    ProgressPrinter progress;
    const SimSummary summary = Simulate(options, [&progress](int vehicle, double share) { progress(vehicle, share); });
    switch (options.layout) {
      case Layout::kWire:
        PrintWire(summary, options.out);
        break;
      case Layout::kSubmaps:
        PrintSubmaps(summary, options.out);
        break;
      default:
        PrintClouds(summary, options.out);
    }
    return 0;
  } catch (const std::exception& e) {
    fmt::print(stderr, "mapweld sim: {}\n", e.what());
    return 1;
  }
}

void AddSimCommand(CLI::App& app) {
  auto options = std::make_shared<SimOptions>();
  CLI::App* command =
      app.add_subcommand("sim", "Drive simulated vehicles through a real town and record their sensors");
  const auto scenario = std::make_shared<std::string>("four_drives");
  const auto submaps = std::make_shared<bool>(false);
  command
      ->add_option("scenario", *scenario, "Its name (four_drives is the demo; a wrong name lists all), or a .json file")
      ->capture_default_str();
  command->add_flag("--submaps", *submaps, "Short for --layout submaps");
  const std::map<std::string, Layout> layouts{{"wire", Layout::kWire},
                                              {"submaps", Layout::kSubmaps},
                                              {"kitti", Layout::kKitti},
                                              {"mulran", Layout::kMulran},
                                              {"gprs", Layout::kGprs}};
  command
      ->add_option("--layout", options->layout,
                   "wire: packets (pcap) and CAN frames (candump), for the agent. submaps: what the agents would have "
                   "published (LCM logs), 50 times faster. kitti, mulran, gprs: clouds and true poses")
      ->transform(CLI::CheckedTransformer(layouts, CLI::ignore_case));
  command->add_option("--lidar", options->lidar, "vlp16, hdl32e, hdl64e, os1-64 or 128")->capture_default_str();
  command->add_flag("--dual-return", options->dual_return,
                    "Layout wire: packets with the last and the strongest return");
  command->add_option("--vibration", options->vibration_mps2,
                      "Layout wire: root mean square of the IMU's trembling along each axis, m/s^2");
  command->add_option("-o,--out", options->out, "Folder for the recordings")->required();
  command->add_option("--vehicles", options->vehicles, "Only these vehicles, for example 1,2")->delimiter(',');
  command->add_option("--seed", options->seed, "Seed of all noise (default: the scenario's)");
  command->add_option("--seconds", options->seconds, "End every drive after this many seconds");
  command->add_option("--threads", options->threads, "Threads (default: one per processor); no effect on the bytes");
  command->callback([options, scenario, submaps] {
    options->scenario = scenario->ends_with(".json") ? std::filesystem::path(*scenario) : ScenarioByName(*scenario);
    if (*submaps) options->layout = Layout::kSubmaps;
    if (const int code = RunSim(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace mapweld::sim
