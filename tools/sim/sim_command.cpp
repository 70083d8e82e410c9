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
  std::int64_t packets = 0;
  for (const VehicleSummary& v : summary.vehicles) {
    const double rays = static_cast<double>(v.counts.packets) * Vlp16::kSequences * Vlp16::kLasers;
    fmt::print("vehicle {}: {:.0f} m in {:.1f} s, {} LiDAR packets ({:.0f} % of the beams return), {} IMU samples\n",
               v.id, v.length_m, v.duration_s, v.counts.packets,
               100 * static_cast<double>(v.counts.returns) / std::max(rays, 1.0), v.counts.imu_samples);
    packets += v.counts.packets;
  }
  const double rays = static_cast<double>(packets) * Vlp16::kSequences * Vlp16::kLasers;
  fmt::print("{}: {} vehicles, {:.1f} million rays in {:.1f} s ({:.2f} million rays/s), town ready after {:.1f} s\n",
             out.string(), summary.vehicles.size(), rays * 1e-6, summary.drive_s, rays * 1e-6 / summary.drive_s,
             summary.prepare_s);
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
    options.depth == Depth::kWire ? PrintWire(summary, options.out) : PrintSubmaps(summary, options.out);
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
  command->add_option("scenario", *scenario, "four_drives (the demo), city, or a .json file")->capture_default_str();
  command->add_flag("--submaps", *submaps,
                    "Write what the agents would have published (LCM logs), not every packet: 50 times faster");
  command->add_option("-o,--out", options->out, "Folder for the recordings")->required();
  command->add_option("--vehicles", options->vehicles, "Only these vehicles, for example 1,2")->delimiter(',');
  command->add_option("--seed", options->seed, "Seed of all noise (default: the scenario's)");
  command->add_option("--seconds", options->seconds, "End every drive after this many seconds");
  command->add_option("--threads", options->threads, "Threads (default: one per processor); no effect on the bytes");
  command->callback([options, scenario, submaps] {
    options->scenario = scenario->ends_with(".json") ? std::filesystem::path(*scenario) : ScenarioByName(*scenario);
    if (*submaps) options->depth = Depth::kSubmaps;
    if (const int code = RunSim(*options); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace mapweld::sim
