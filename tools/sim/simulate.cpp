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

#include "tools/sim/hash_noise.hpp"
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
  std::uint64_t seed;
};

std::vector<int> VehicleIds(const Scenario& scenario) {
  std::vector<int> ids;
  for (const VehiclePlan& plan : scenario.vehicles) ids.push_back(plan.id);
  if (scenario.survey) {
    for (int id = 1; id <= scenario.survey->drives; ++id) ids.push_back(id);
  }
  return ids;
}

std::vector<Job> SelectJobs(const Scenario& scenario, const SimOptions& options, std::uint64_t seed) {
  std::vector<Job> jobs;
  const std::vector<int> ids = VehicleIds(scenario);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const bool wanted = options.vehicles.empty() ||
                        std::find(options.vehicles.begin(), options.vehicles.end(), ids[i]) != options.vehicles.end();
    if (!wanted) continue;
    jobs.push_back({i, ids[i], (600 + static_cast<std::int64_t>(ids[i])) * 1'000'000'000,
                    Hash(seed, static_cast<std::uint64_t>(ids[i]))});
  }
  for (const int id : options.vehicles) {
    const bool known = std::any_of(jobs.begin(), jobs.end(), [id](const Job& job) { return job.id == id; });
    if (!known) throw std::runtime_error(fmt::format("the scenario has no vehicle {}", id));
  }
  return jobs;
}

std::string WireFolder(int id) {
  return fmt::format("vehicle_{}", id);
}
std::string LogName(int id) {
  return fmt::format("agent_{}", id);
}

VehicleSummary Drive(const SimWorld& world, const LanePath& lane, const Job& job, const SimOptions& options,
                     const std::filesystem::path& out, const std::function<void(int, double)>& progress) {
  const VehicleMotion motion(lane, DrivingStyle{}, job.seed);
  VehicleSummary summary;
  summary.id = job.id;
  summary.duration_s = std::min(motion.duration_s(), options.seconds.value_or(motion.duration_s()));
  constexpr double kStep_s = 0.1;
  for (double t = 0; t + kStep_s <= summary.duration_s; t += kStep_s) {
    summary.length_m += motion.VelocityWorld(t + kStep_s / 2).head<2>().norm() * kStep_s;
  }
  const auto report = [&](double share) { progress(job.id, share); };
  if (options.depth == Depth::kWire) {
    DriveSpec spec;
    spec.start_past_hour_ns = job.start_past_hour_ns;
    spec.duration_s = summary.duration_s;
    spec.seed = job.seed;
    const std::filesystem::path folder = out / WireFolder(job.id);
    std::filesystem::create_directories(folder);
    summary.counts = WriteRecording(world.caster(), motion, spec, folder, report);
  } else {
    AgentLogSpec spec;
    spec.agent_id = static_cast<std::int16_t>(job.id);
    spec.start_past_hour_ns = job.start_past_hour_ns;
    spec.duration_s = summary.duration_s;
    spec.seed = job.seed;
    const std::string name = LogName(job.id);
    std::filesystem::create_directories(out / "truth");
    summary.log =
        WriteAgentLog(world.caster(), motion, spec, out / (name + ".lcm"), out / "truth" / (name + ".tum"), report);
  }
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
  InParallel(planned.size(), threads, [&](std::size_t i) { planned[i] = LanePath::Beside(world.route(i).centreline); });
  std::vector<LanePath> lanes;
  for (std::optional<LanePath>& lane : planned) lanes.push_back(std::move(*lane));
  return lanes;
}

nlohmann::ordered_json Describe(const Scenario& scenario, const SimWorld& world, const std::vector<Job>& jobs,
                                const std::vector<TrueOverlap>& overlaps, const SimSummary& summary, Depth depth,
                                std::uint64_t seed) {
  using nlohmann::ordered_json;
  const LidarModel lidar;
  const auto& t = lidar.body_T_lidar.t;
  const auto& q = lidar.body_T_lidar.q;
  const std::vector<int> ids = VehicleIds(scenario);
  ordered_json vehicles = ordered_json::array();
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    ordered_json vehicle;
    vehicle["id"] = jobs[k].id;
    if (depth == Depth::kWire) {
      vehicle["folder"] = WireFolder(jobs[k].id);
    } else {
      vehicle["log"] = LogName(jobs[k].id) + ".lcm";
    }
    vehicle["zone"] = world.zone(jobs[k].index);
    vehicle["start_s"] = static_cast<double>(jobs[k].start_past_hour_ns) * 1e-9;
    vehicle["duration_s"] = summary.vehicles[k].duration_s;
    vehicle["length_m"] = summary.vehicles[k].length_m;
    if (!scenario.survey) {
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
          {"attribution", "town: © OpenStreetMap contributors, ODbL 1.0"},
          {"town", scenario.town.filename().string()},
          {"origin_lat_lon", {scenario.origin.lat_deg, scenario.origin.lon_deg}},
          {"seed", seed},
          {"depth", depth == Depth::kWire ? "wire" : "submaps"},
          {"lidar", "VLP-16, 600 rpm, strongest return"},
          {"imu", "Xsens MTi-600 CAN, 200 Hz"},
          {"body_T_lidar", {{"t_m", {t.x(), t.y(), t.z()}}, {"q_xyzw", {q.x(), q.y(), q.z(), q.w()}}}},
          {"vehicles", vehicles},
          {"overlaps_of_whole_routes", together}};
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
  const Scenario scenario = ReadScenario(options.scenario);
  const std::uint64_t seed = options.seed.value_or(scenario.seed);
  const std::vector<Job> jobs = SelectJobs(scenario, options, seed);
  StagedFolder folder(options.out, kScenarioFile);
  const SimWorld world(scenario, seed);
  const std::vector<LanePath> lanes = PlanLanes(world, options.threads);
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
  description.Write(Describe(scenario, world, jobs, overlaps, summary, options.depth, seed).dump(2) + "\n");
  description.Close();
  folder.Publish();
  summary.drive_s = SecondsSince(begin) - summary.prepare_s;
  return summary;
}

}  // namespace mapweld::sim
