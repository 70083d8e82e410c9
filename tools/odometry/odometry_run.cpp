// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/odometry_run.hpp"

#include <ctime>
#include <memory>

#include "tools/odometry/drive_player.hpp"

namespace mapweld::odometry {
namespace {

double ThreadCpuMs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

class AgentRun final : public SensorSink, public pipeline::AgentSink {
 public:
  explicit AgentRun(const pipeline::AgentConfig& config)
      : agent_(std::make_unique<pipeline::AgentPipeline>(config, this)) {}

  void OnImu(const sensor::ImuSample& sample) override {
    Timed([&] { agent_->OnImu(sample); });
  }
  void OnPacket(const sensor::LidarPacket& packet) override {
    Timed([&] { agent_->OnPacket(packet); });
  }
  void OnPose(const pipeline::PoseOutput& pose) override { run_.scans.push_back({pose.odometry, 0}); }
  void OnKeyframe(const pipeline::KeyframeOutput& keyframe) override {
    run_.submap_bytes.push_back(keyframe.encoded.size());
    run_.submap_points.push_back(keyframe.submap_points);
  }

  OdometryRun Finish() {
    agent_->OnDriveEnd();
    run_.counters = agent_->counters();
    return std::move(run_);
  }

 private:
  template <typename Call>
  void Timed(const Call& call) {
    const std::size_t before = run_.scans.size();
    const double begin = ThreadCpuMs();
    call();
    if (run_.scans.size() != before) run_.scans.back().cpu_ms = ThreadCpuMs() - begin;
  }

  std::unique_ptr<pipeline::AgentPipeline> agent_;
  OdometryRun run_;
};

}  // namespace

OdometryRun RunDrive(const std::filesystem::path& drive, const pipeline::AgentConfig& config,
                     const FaultMaker& faults) {
  AgentRun run(config);
  const std::unique_ptr<SensorSink> faulty = faults ? faults(&run) : nullptr;
  PlayDrive(drive, faulty ? faulty.get() : &run);
  return run.Finish();
}

OdometryRun RunClouds(const io::RecordingFolder& folder, const lio::LioConfig& config, Sweep sweep) {
  OdometryRun run;
  const auto lio = std::make_unique<lio::Lio>(config);
  const auto scan = std::make_unique<sensor::Scan>();
  for (std::size_t i = 0; i < folder.size(); ++i) {
    LoadScan(folder, i, sweep, scan.get());
    ScanRecord record;
    const double begin = ThreadCpuMs();
    if (lio->AddScan(*scan, &record.update) != Status::kOk) {
      ++run.counters.scans_dropped;
      continue;
    }
    record.cpu_ms = ThreadCpuMs() - begin;
    ++run.counters.scans;
    run.scans.push_back(record);
  }
  return run;
}

}  // namespace mapweld::odometry
