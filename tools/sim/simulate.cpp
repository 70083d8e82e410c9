// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>

#include "tools/sim/cloud_writer.hpp"
#include "tools/sim/output_file.hpp"
#include "tools/sim/overlap_truth.hpp"
#include "tools/sim/sim_world.hpp"
#include "tools/sim/staged_folder.hpp"

namespace mapweld::sim {
namespace {

constexpr const char* kScenarioFile = "scenario.json";

struct Job {
  std::size_t index;  // in the scenario
  int id;
  std::int64_t start_past_hour_ns;
};

std::vector<Job> SelectJobs(const Scenario& scenario, const SimOptions& options) {
  std::vector<Job> jobs;
  const std::vector<int> ids = VehicleIds(scenario);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const bool wanted = options.vehicles.empty() ||
                        std::find(options.vehicles.begin(), options.vehicles.end(), ids[i]) != options.vehicles.end();
    if (!wanted) continue;
    jobs.push_back({i, ids[i], (600 + static_cast<std::int64_t>(ids[i])) * 1'000'000'000});
  }
  for (const int id : options.vehicles) {
    const bool known = std::any_of(jobs.begin(), jobs.end(), [id](const Job& job) { return job.id == id; });
    if (!known) throw std::runtime_error(fmt::format("the scenario has no vehicle {}", id));
  }
  return jobs;
}

std::string VehicleFolder(int id) {
  return fmt::format("vehicle_{}", id);
}
std::string LogName(int id) {
  return fmt::format("agent_{}", id);
}

VehicleSummary Drive(const SimWorld& world, const LanePath& lane, const Job& job, const SimOptions& options,
                     const std::filesystem::path& out, const std::function<void(int, double)>& progress) {
  const std::uint64_t seed = world.drive_seed(job.index);
  DrivingStyle style;
  style.max_speed_mps = world.max_speed_mps();
  const VehicleMotion motion(lane, style, world.relief(), seed);
  const Traffic traffic(lane, motion, world.relief(), world.traffic(), seed);
  const RayCaster caster = world.CasterOf(job.index);
  VehicleSummary summary;
  summary.id = job.id;
  summary.duration_s = std::min(motion.duration_s(), options.seconds.value_or(motion.duration_s()));
  constexpr double kStep_s = 0.1;
  for (double t = 0; t + kStep_s <= summary.duration_s; t += kStep_s) {
    summary.length_m += motion.VelocityWorld(t + kStep_s / 2).head<2>().norm() * kStep_s;
  }
  const auto report = [&](double share) { progress(job.id, share); };
  const Weather weather = world.WeatherOf(job.index);
  const LidarModel lidar = LidarByName(options.lidar);
  if (options.layout == Layout::kSubmaps) {
    AgentLogSpec spec;
    spec.agent_id = static_cast<std::int16_t>(job.id);
    spec.start_past_hour_ns = job.start_past_hour_ns;
    spec.duration_s = summary.duration_s;
    spec.seed = seed;
    spec.lidar = lidar;
    spec.weather = weather;
    const std::string name = LogName(job.id);
    std::filesystem::create_directories(out / "truth");
    summary.log =
        WriteAgentLog(caster, motion, &traffic, spec, out / (name + ".lcm"), out / "truth" / (name + ".tum"), report);
    return summary;
  }
  const std::filesystem::path folder = out / VehicleFolder(job.id);
  std::filesystem::create_directories(folder);
  if (options.layout == Layout::kWire) {
    DriveSpec spec;
    spec.start_past_hour_ns = job.start_past_hour_ns;
    spec.duration_s = summary.duration_s;
    spec.seed = seed;
    spec.lidar = lidar;
    spec.dual_return = options.dual_return;
    spec.imu.vibration_mps2 = options.vibration_mps2;
    spec.weather = weather;
    summary.counts = WriteRecording(caster, motion, &traffic, spec, folder, report);
    return summary;
  }
  CloudSpec spec;
  spec.layout = options.layout == Layout::kKitti    ? CloudLayout::kKitti
                : options.layout == Layout::kMulran ? CloudLayout::kMulran
                                                    : CloudLayout::kGprs;
  spec.lidar = lidar;
  spec.weather = weather;
  spec.start_past_hour_ns = job.start_past_hour_ns;
  spec.duration_s = summary.duration_s;
  spec.seed = seed;
  summary.clouds = WriteClouds(caster, motion, &traffic, spec, folder, report);
  return summary;
}

// One job after the other on each of a few threads; the first failure stops the rest.
template <class Work>
void InParallel(std::size_t jobs, unsigned threads_wanted, const Work& work) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto run = [&] {
    for (std::size_t i = next++; i < jobs; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = jobs;
      }
    }
  };
  const std::size_t wanted = threads_wanted != 0 ? threads_wanted : std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < std::min(wanted, jobs); ++i) threads.emplace_back(run);
  run();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

std::vector<LanePath> PlanLanes(const SimWorld& world, unsigned threads) {
  std::vector<std::optional<LanePath>> planned(world.vehicles());
  InParallel(planned.size(), threads, [&](std::size_t i) { planned[i] = world.PlanLane(i); });
  std::vector<LanePath> lanes;
  for (std::optional<LanePath>& lane : planned) lanes.push_back(std::move(*lane));
  return lanes;
}

const char* LayoutName(Layout layout) {
  switch (layout) {
    case Layout::kSubmaps:
      return "submaps";
    case Layout::kKitti:
      return "kitti";
    case Layout::kMulran:
      return "mulran";
    case Layout::kGprs:
      return "gprs";
    case Layout::kWire:
      break;
  }
  return "wire";
}

std::string TownName(const TownSource& source) {
  if (const auto* plan = std::get_if<TownPlan>(&source)) {
    return fmt::format("invented: {}, {:.0f} m, seed {}", plan->style, plan->size_m, plan->seed);
  }
  const auto& file = std::get<std::filesystem::path>(source);
  const std::string name = file.filename().string();
  return file.extension() == ".json" ? name : name + ", © OpenStreetMap contributors, ODbL 1.0";
}

nlohmann::ordered_json Describe(const Scenario& scenario, const SimWorld& world, const std::vector<Job>& jobs,
                                const std::vector<TrueOverlap>& overlaps, const SimSummary& summary,
                                const SimOptions& options, std::uint64_t seed) {
  using nlohmann::ordered_json;
  const LidarModel lidar = LidarByName(options.lidar);
  const auto& t = lidar.body_T_lidar.t;
  const auto& q = lidar.body_T_lidar.q;
  const std::vector<int> ids = VehicleIds(scenario);
  ordered_json vehicles = ordered_json::array();
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    ordered_json vehicle;
    vehicle["id"] = jobs[k].id;
    if (options.layout == Layout::kSubmaps) {
      vehicle["log"] = LogName(jobs[k].id) + ".lcm";
    } else {
      vehicle["folder"] = VehicleFolder(jobs[k].id);
    }
    vehicle["rain_mm_per_h"] = world.WeatherOf(jobs[k].index).rain_mm_per_h;
    vehicle["zone"] = world.zone(jobs[k].index);
    vehicle["start_s"] = static_cast<double>(jobs[k].start_past_hour_ns) * 1e-9;
    vehicle["duration_s"] = summary.vehicles[k].duration_s;
    vehicle["length_m"] = summary.vehicles[k].length_m;
    if (!scenario.vehicles.empty()) {
      for (const GeoPoint& p : scenario.vehicles[jobs[k].index].waypoints) {
        vehicle["route_lat_lon"].push_back({p.lat_deg, p.lon_deg});
      }
    }
    vehicles.push_back(std::move(vehicle));
  }
  ordered_json together = ordered_json::array();
  for (const TrueOverlap& o : overlaps) {
    together.push_back({{"vehicles", {ids[static_cast<std::size_t>(o.a)], ids[static_cast<std::size_t>(o.b)]}},
                        {"kind", o.Shared() >= kMinOverlap_m ? "overlap" : "crossing"},
                        {"same_direction_m", o.same_direction_m},
                        {"opposite_direction_m", o.opposite_direction_m},
                        {"crossing_m", o.crossing_m}});
  }
  return {{"name", scenario.name},
          {"town", scenario.paths ? "invented around real paths" : TownName(scenario.town)},
          {"origin_lat_lon", {scenario.origin.lat_deg, scenario.origin.lon_deg}},
          {"seed", seed},
          {"layout", LayoutName(options.layout)},
          {"lidar", fmt::format("{}, 600 rpm, {} return", lidar.name, options.dual_return ? "dual" : "strongest")},
          {"imu", "Xsens MTi-600 CAN, 200 Hz" + (options.vibration_mps2 > 0
                                                     ? fmt::format(", trembling {} m/s^2", options.vibration_mps2)
                                                     : std::string())},
          {"body_T_lidar", {{"t_m", {t.x(), t.y(), t.z()}}, {"q_xyzw", {q.x(), q.y(), q.z(), q.w()}}}},
          {"vehicles", vehicles},
          {"overlaps_of_whole_routes", together}};
}

// Refuses before any work is lost. About what the drives will take: a second of packets per 8 m, a cloud per metre, or
// a submap per 5 m.
void CheckDiskSpace(const std::filesystem::path& folder, const std::vector<LanePath>& lanes,
                    const std::vector<Job>& jobs, const SimOptions& options) {
  double length_m = 0;
  for (const Job& job : jobs) {
    const double longest_m = options.seconds.value_or(1e9) * 10;
    length_m += std::min(lanes[job.index].length_m(), longest_m);
  }
  const LidarModel lidar = LidarByName(options.lidar);
  const double shots =
      static_cast<double>(lidar.beams.size()) * static_cast<double>(kRevolution_ns * 1000 / lidar.column_ps);
  double bytes_per_m = 0;
  switch (options.layout) {
    case Layout::kWire:
      bytes_per_m = 10 * shots * PacketBytesPerBeam(lidar) / 8 * (options.dual_return ? 2 : 1);
      break;
    case Layout::kSubmaps:
      bytes_per_m = 70'000 / 5.0;
      break;
    case Layout::kKitti:
    case Layout::kMulran:
      bytes_per_m = 16 * shots * 0.7;
      break;
    case Layout::kGprs:
      bytes_per_m = 10 * 12 * shots * 0.7;
      break;
  }
  const double needed = length_m * bytes_per_m;
  const auto there = static_cast<double>(std::filesystem::space(folder).available);
  if (needed > there) {
    throw std::runtime_error(
        fmt::format("{} needs about {:.1f} GB and its disk has {:.1f}; choose another disk with -o",
                    options.out.string(), needed * 1e-9, there * 1e-9));
  }
}

double SecondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

SimSummary Simulate(const SimOptions& options, const std::function<void(int, double)>& progress) {
  const auto begin = std::chrono::steady_clock::now();
  if (options.seconds && !(*options.seconds >= 0.1)) {
    throw std::runtime_error(fmt::format("--seconds {} is too short; the least is 0.1", *options.seconds));
  }
  const LidarModel lidar = LidarByName(options.lidar);
  if (options.layout == Layout::kWire && PacketColumns(lidar, options.dual_return) == 0) {
    throw std::runtime_error(fmt::format("{}{} packets are not written; choose --layout kitti, or --lidar vlp16{}",
                                         options.dual_return ? "dual return " : "", options.lidar,
                                         options.dual_return ? " or hdl32e" : ", hdl32e or os1-64"));
  }
  if (options.vibration_mps2 < 0 || options.vibration_mps2 > 20) {
    throw std::runtime_error(fmt::format("--vibration {} is not between 0 and 20 m/s^2", options.vibration_mps2));
  }
  if (options.dual_return && options.layout != Layout::kWire) {
    throw std::runtime_error("--dual-return is a mode of the packets; choose --layout wire");
  }
  const Scenario scenario = ReadScenario(options.scenario);
  const std::uint64_t seed = options.seed.value_or(scenario.seed);
  const std::vector<Job> jobs = SelectJobs(scenario, options);
  StagedFolder folder(options.out, kScenarioFile);
  const SimWorld world(scenario, seed);
  const std::vector<LanePath> lanes = PlanLanes(world, options.threads);
  CheckDiskSpace(folder.path(), lanes, jobs, options);
  const std::vector<TrueOverlap> overlaps = FindTrueOverlaps(lanes);
  SimSummary summary;
  summary.overlaps = static_cast<int>(std::count_if(overlaps.begin(), overlaps.end(),
                                                    [](const TrueOverlap& o) { return o.Shared() >= kMinOverlap_m; }));
  summary.prepare_s = SecondsSince(begin);
  summary.vehicles.resize(jobs.size());
  InParallel(jobs.size(), options.threads, [&](std::size_t i) {
    summary.vehicles[i] = Drive(world, lanes[jobs[i].index], jobs[i], options, folder.path(), progress);
  });
  OutputFile description(folder.path() / kScenarioFile);
  description.Write(Describe(scenario, world, jobs, overlaps, summary, options, seed).dump(2) + "\n");
  description.Close();
  folder.Publish();
  summary.drive_s = SecondsSince(begin) - summary.prepare_s;
  return summary;
}

}  // namespace mapweld::sim
