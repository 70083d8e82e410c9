// SPDX-License-Identifier: Apache-2.0
// Ours beside other odometries: the same scans of a drive, one after the other in one process on one thread, CPU time
// and drift of each. Ours takes the sensors' bytes, as on the vehicle, and de-skews by itself; the others, which know
// no IMU, get the scans without distortion. "ours without IMU" gets what the others get.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <numeric>

#include "core/lio/lio.hpp"
#include "tests/bench/odometry_engine.hpp"
#include "tools/eval/segment_error.hpp"
#include "tools/eval/trajectory_error.hpp"
#include "tools/odometry/odometry_report.hpp"
#include "tools/odometry/odometry_run.hpp"
#include "tools/odometry/sensor_faults.hpp"
#include "tools/odometry/true_scans.hpp"

namespace mapweld::bench {
namespace {

namespace fs = std::filesystem;

double CpuMs() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);  // of all threads, should anyone start some
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

class OursWithoutImu final : public OdometryEngine {
 public:
  OursWithoutImu() {
    lio::LioConfig config;
    config.use_imu = false;
    config.body_T_lidar = {};
    lio_ = std::make_unique<lio::Lio>(config);
  }
  [[nodiscard]] std::string name() const override { return "ours without IMU"; }
  geom::Pose3 Register(const std::vector<Eigen::Vector3f>& points) override {
    scan_->t_begin = scan_->t_end;
    scan_->t_end = scan_->t_begin + Milliseconds(100);
    scan_->points.clear();
    const auto at_end = static_cast<std::int32_t>(Milliseconds(100).ns);
    for (const Eigen::Vector3f& p : points) (void)scan_->points.TryPush({p.x(), p.y(), p.z(), 0, at_end, 0, 0});
    lio::LioUpdate update;
    if (lio_->AddScan(*scan_, &update) == Status::kOk) last_ = update.odom_T_body;
    return last_;
  }

 private:
  std::unique_ptr<lio::Lio> lio_;
  std::unique_ptr<sensor::Scan> scan_ = std::make_unique<sensor::Scan>();
  geom::Pose3 last_;
};

struct Score {
  std::string name;
  std::vector<double> cpu_ms;
  std::vector<io::StampedPose> truth;
  std::vector<io::StampedPose> estimate;
};

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

void Print(const Score& score) {
  std::vector<double> step_mm;
  double path_m = 0;
  for (std::size_t i = 1; i < score.truth.size(); ++i) {
    const auto step = [i](const std::vector<io::StampedPose>& poses) {
      return poses[i - 1].world_T_body.Inverse() * poses[i].world_T_body;
    };
    step_mm.push_back(1e3 * (step(score.estimate).t - step(score.truth).t).norm());
    path_m += step(score.truth).t.norm();
  }
  const eval::SegmentError drift = eval::SegmentDrift(score.truth, score.estimate);
  const double rmse_m = eval::EvaluateGroup({{score.name, score.truth, score.estimate}}).all.rmse_m;
  const double mean = std::accumulate(score.cpu_ms.begin(), score.cpu_ms.end(), 0.0) /
                      static_cast<double>(std::max<std::size_t>(score.cpu_ms.size(), 1));
  fmt::print("{:<20} {:>6} {:>7.0f} {:>7.2f} {:>7.2f} {:>7.2f} {:>7.2f} {:>8.3f} {:>9.5f} {:>8.2f} {:>8.2f}\n",
             score.name, score.cpu_ms.size(), path_m, mean, Quantile(score.cpu_ms, 0.5), Quantile(score.cpu_ms, 0.99),
             Quantile(score.cpu_ms, 1.0), drift.translation_percent, drift.rotation_deg_per_m, Quantile(step_mm, 0.5),
             rmse_m);
}

struct Arguments {
  fs::path drive;
  std::vector<std::string> faults;
  std::size_t max_scans = 1'000'000;
};

void Run(const Arguments& arguments) {
  std::vector<odometry::Fault> faults;
  for (const std::string& fault : arguments.faults) faults.push_back(odometry::ParseFault(fault));
  std::vector<std::unique_ptr<OdometryEngine>> engines;
  engines.push_back(std::make_unique<OursWithoutImu>());
#ifdef MAPWELD_BENCH_KISS_ICP
  engines.push_back(MakeKissIcp());
#endif
#ifdef MAPWELD_BENCH_SMALL_GICP
  engines.push_back(MakeSmallGicp());
#endif
#ifdef MAPWELD_BENCH_PCL
  engines.push_back(MakePclGicp());
#endif
  std::vector<Score> scores(engines.size());
  for (std::size_t i = 0; i < engines.size(); ++i) scores[i].name = engines[i]->name();

  const std::vector<io::StampedPose> world_T_body = io::ReadTum(arguments.drive / "truth.tum");
  const pipeline::AgentConfig config;
  odometry::TrueScans scans(world_T_body, config.lio.body_T_lidar, [&](const odometry::TrueScan& scan) {
    if (scores[0].cpu_ms.size() >= arguments.max_scans) return;
    for (std::size_t i = 0; i < engines.size(); ++i) {
      const double begin = CpuMs();
      const geom::Pose3 pose = engines[i]->Register(scan.points);
      scores[i].cpu_ms.push_back(CpuMs() - begin);
      scores[i].estimate.push_back({scan.t, pose});
      scores[i].truth.push_back({scan.t, scan.world_T_lidar});
    }
    if (scores[0].cpu_ms.size() % 100 == 0) fmt::print(stderr, "{} scans\n", scores[0].cpu_ms.size());
  });
  // A chain that owns its parts: agent and scans <- tee <- faults <- player.
  std::unique_ptr<odometry::Tee> tee;
  const odometry::OdometryRun run = odometry::RunDrive(arguments.drive, config, [&](odometry::SensorSink* agent) {
    tee = std::make_unique<odometry::Tee>(agent, &scans);
    return odometry::MakeFaults(faults, tee.get());
  });
  Score odometry_alone{"ours", {}, {}, {}};
  Score whole{"ours, whole agent", {}, {}, {}};
  for (const odometry::ScanRecord& scan : run.scans) {
    geom::Pose3 truth;
    if (whole.cpu_ms.size() >= arguments.max_scans || !eval::TruthAt(world_T_body, scan.update.t, &truth)) continue;
    odometry_alone.cpu_ms.push_back(scan.odometry_ms);
    whole.cpu_ms.push_back(scan.cpu_ms);
    for (Score* score : {&odometry_alone, &whole}) {
      score->truth.push_back({scan.update.t, truth});
      score->estimate.push_back({scan.update.t, scan.update.odom_T_body});
    }
  }

  fmt::print("{:<20} {:>6} {:>7} {:>7} {:>7} {:>7} {:>7} {:>8} {:>9} {:>8} {:>8}\n", "CPU ms per scan", "scans",
             "path m", "mean", "median", "p99", "max", "drift %", "deg/m", "step mm", "rmse m");
  Print(odometry_alone);
  Print(whole);
  for (const Score& score : scores) Print(score);
}

}  // namespace
}  // namespace mapweld::bench

int main(int argc, char** argv) {
  CLI::App app("Compares odometries on the scans of a simulated drive");
  mapweld::bench::Arguments arguments;
  app.add_option("drive", arguments.drive, "Folder with lidar.pcap, imu.candump and truth.tum")->required();
  app.add_option("--fault", arguments.faults, "As of mapweld odometry, for example traffic:30");
  app.add_option("--max-scans", arguments.max_scans, "Score only so many");
  CLI11_PARSE(app, argc, argv);
  try {
    mapweld::bench::Run(arguments);
  } catch (const std::exception& e) {
    fmt::print(stderr, "odometry_bench: {}\n", e.what());
    return 1;
  }
  return 0;
}
