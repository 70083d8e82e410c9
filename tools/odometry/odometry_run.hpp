// SPDX-License-Identifier: Apache-2.0
// The agent's odometry over a whole recording, with what each scan cost.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "core/lio/lio.hpp"
#include "core/pipeline/agent_pipeline.hpp"
#include "tools/odometry/cloud_player.hpp"
#include "tools/odometry/sensor_sink.hpp"

namespace mapweld::odometry {

struct ScanRecord {
  lio::LioUpdate update;
  double odometry_ms = 0;  // CPU time of this thread: samples, packets and the scan itself, until its pose was known
  double cpu_ms = 0;       // the same with submaps and keyframes
};

struct KeyframeRecord {
  TimeNs t;
  bool flushed = false;
  std::size_t points = 0;             // of its submap
  std::vector<std::uint8_t> encoded;  // the submap as it would be sent
};

struct OdometryRun {
  std::vector<ScanRecord> scans;
  pipeline::AgentCounters counters;
  std::vector<KeyframeRecord> keyframes;
};

// The whole agent (odometry, submaps, descriptors) on a drive's sensors. `faults` may put something between the
// sensors and the agent; the sink it gets outlives it.
using FaultMaker = std::function<std::unique_ptr<SensorSink>(SensorSink*)>;
OdometryRun RunDrive(const std::filesystem::path& drive, const pipeline::AgentConfig& config, const FaultMaker& faults);

// The odometry alone, without an IMU, on a folder of clouds; body is the LiDAR.
OdometryRun RunClouds(const io::RecordingFolder& folder, const lio::LioConfig& config, Sweep sweep);

}  // namespace mapweld::odometry
