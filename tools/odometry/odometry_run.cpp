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
    begin_ms_ = ThreadCpuMs();
    agent_->OnImu(sample);
    Book();
  }
  void OnPacket(const sensor::LidarPacket& packet) override {
    begin_ms_ = ThreadCpuMs();
    agent_->OnPacket(packet);
    Book();
  }
  void OnPose(const pipeline::PoseOutput& pose) override {
    run_.scans.push_back({pose.odometry, waiting_ms_ + ThreadCpuMs() - begin_ms_, 0});
  }
  void OnKeyframe(const pipeline::KeyframeOutput& keyframe) override {
    run_.keyframes.push_back({keyframe.t, keyframe.flushed, keyframe.submap_points,
                              std::vector<std::uint8_t>(keyframe.encoded.begin(), keyframe.encoded.end())});
  }

  OdometryRun Finish() {
    agent_->OnDriveEnd();
    run_.counters = agent_->counters();
    return std::move(run_);
  }

 private:
  // What the packets and samples of a scan cost before it was complete is part of its cost.
  void Book() {
    waiting_ms_ += ThreadCpuMs() - begin_ms_;
    if (run_.scans.size() == booked_) return;
    run_.scans.back().cpu_ms = waiting_ms_;
    booked_ = run_.scans.size();
    waiting_ms_ = 0;
  }

  std::unique_ptr<pipeline::AgentPipeline> agent_;
  double begin_ms_ = 0;    // of the present call
  double waiting_ms_ = 0;  // calls since the last scan
  std::size_t booked_ = 0;
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
    record.odometry_ms = record.cpu_ms;
    ++run.counters.scans;
    run.scans.push_back(record);
  }
  return run;
}

}  // namespace mapweld::odometry
