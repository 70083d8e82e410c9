// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "tools/sim/hash_noise.hpp"
#include "tools/sim/output_file.hpp"
#include "tools/sim/sim_world.hpp"
#include "tools/sim/staged_folder.hpp"

namespace mapweld::sim {
namespace {

constexpr const char* kScenarioFile = "scenario.json";

struct Job {
  std::size_t index;  // in the scenario
  int id;
  DriveSpec spec;
};

std::vector<Job> SelectJobs(const Scenario& scenario, const SimOptions& options) {
  std::vector<Job> jobs;
  const std::uint64_t seed = options.seed.value_or(scenario.seed);
  for (std::size_t i = 0; i < scenario.vehicles.size(); ++i) {
    const int id = scenario.vehicles[i].id;
    const bool wanted = options.vehicles.empty() ||
                        std::find(options.vehicles.begin(), options.vehicles.end(), id) != options.vehicles.end();
    if (!wanted) continue;
    DriveSpec spec;
    spec.start_past_hour_ns = (600 + static_cast<std::int64_t>(id)) * 1'000'000'000;
    spec.seed = Hash(seed, static_cast<std::uint64_t>(id));
    jobs.push_back({i, id, spec});
  }
  for (const int id : options.vehicles) {
    const bool known = std::any_of(jobs.begin(), jobs.end(), [id](const Job& job) { return job.id == id; });
    if (!known) throw std::runtime_error(fmt::format("the scenario has no vehicle {}", id));
  }
  return jobs;
}

VehicleSummary Drive(const SimWorld& world, const Job& job, const SimOptions& options, const std::filesystem::path& dir,
                     const std::function<void(int, double)>& progress) {
  const LanePath lane = LanePath::Beside(world.route(job.index).centreline);
  const VehicleMotion motion(lane, DrivingStyle{}, job.spec.seed);
  DriveSpec spec = job.spec;
  spec.duration_s = std::min(motion.duration_s(), options.seconds.value_or(motion.duration_s()));
  std::filesystem::create_directories(dir);
  VehicleSummary summary{job.id, 0, spec.duration_s, {}};
  constexpr double kStep_s = 0.1;
  for (double t = 0; t + kStep_s <= spec.duration_s; t += kStep_s) {
    summary.length_m += motion.VelocityWorld(t + kStep_s / 2).head<2>().norm() * kStep_s;
  }
  summary.counts = WriteRecording(world.caster(), motion, spec, dir, [&](double share) { progress(job.id, share); });
  return summary;
}

// The vehicles one after the other on each of a few threads; the first failure stops the rest.
std::vector<VehicleSummary> DriveAll(const SimWorld& world, const std::vector<Job>& jobs, const SimOptions& options,
                                     const std::filesystem::path& dir,
                                     const std::function<void(int, double)>& progress) {
  std::vector<VehicleSummary> summaries(jobs.size());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size(); i = next++) {
      try {
        summaries[i] = Drive(world, jobs[i], options, dir / fmt::format("vehicle_{}", jobs[i].id), progress);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = jobs.size();
      }
    }
  };
  const std::size_t wanted = options.threads != 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < std::min(wanted, jobs.size()); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
  return summaries;
}

nlohmann::ordered_json Describe(const Scenario& scenario, const SimWorld& world, const std::vector<Job>& jobs,
                                const std::vector<VehicleSummary>& summaries, std::uint64_t seed) {
  using nlohmann::ordered_json;
  const LidarModel lidar;
  const auto& t = lidar.body_T_lidar.t;
  const auto& q = lidar.body_T_lidar.q;
  ordered_json vehicles = ordered_json::array();
  ordered_json shared = ordered_json::array();
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    ordered_json route = ordered_json::array();
    for (const GeoPoint& p : scenario.vehicles[jobs[k].index].waypoints) route.push_back({p.lat_deg, p.lon_deg});
    vehicles.push_back({{"id", jobs[k].id},
                        {"folder", fmt::format("vehicle_{}", jobs[k].id)},
                        {"start_s", static_cast<double>(jobs[k].spec.start_past_hour_ns) * 1e-9},
                        {"duration_s", summaries[k].duration_s},
                        {"length_m", summaries[k].length_m},
                        {"route_lat_lon", route}});
    for (std::size_t m = 0; m < k; ++m) {
      const SharedStreet s = FindSharedStreet(world.route(jobs[m].index), world.route(jobs[k].index));
      shared.push_back({{"vehicles", {jobs[m].id, jobs[k].id}},
                        {"same_direction_m", s.same_direction_m},
                        {"opposite_direction_m", s.opposite_direction_m}});
    }
  }
  return {{"name", scenario.name},
          {"attribution", "town: © OpenStreetMap contributors, ODbL 1.0"},
          {"town", scenario.town.filename().string()},
          {"origin_lat_lon", {scenario.origin.lat_deg, scenario.origin.lon_deg}},
          {"seed", seed},
          {"lidar", "VLP-16, 600 rpm, strongest return"},
          {"imu", "Xsens MTi-600 CAN, 200 Hz"},
          {"body_T_lidar", {{"t_m", {t.x(), t.y(), t.z()}}, {"q_xyzw", {q.x(), q.y(), q.z(), q.w()}}}},
          {"vehicles", vehicles},
          {"shared_street_of_whole_routes", shared}};
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
  const std::vector<Job> jobs = SelectJobs(scenario, options);
  StagedFolder folder(options.out, kScenarioFile);
  const SimWorld world(scenario);
  SimSummary summary;
  summary.prepare_s = SecondsSince(begin);
  summary.vehicles = DriveAll(world, jobs, options, folder.path(), progress);
  OutputFile description(folder.path() / kScenarioFile);
  description.Write(Describe(scenario, world, jobs, summary.vehicles, options.seed.value_or(scenario.seed)).dump(2) +
                    "\n");
  description.Close();
  folder.Publish();
  summary.drive_s = SecondsSince(begin) - summary.prepare_s;
  return summary;
}

}  // namespace mapweld::sim
