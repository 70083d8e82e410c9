// SPDX-License-Identifier: Apache-2.0
// The agent's odometry over a whole recording, with what each scan cost.
#pragma once

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
  double cpu_ms = 0;  // of this thread, for the scan and everything that followed from it
};

struct OdometryRun {
  std::vector<ScanRecord> scans;
  pipeline::AgentCounters counters;
  std::vector<std::size_t> submap_bytes;   // encoded, one per keyframe
  std::vector<std::size_t> submap_points;  // one per keyframe
};

// The whole agent (odometry, submaps, descriptors) on a drive's sensors. `faults` may put something between the
// sensors and the agent; the sink it gets outlives it.
using FaultMaker = std::function<std::unique_ptr<SensorSink>(SensorSink*)>;
OdometryRun RunDrive(const std::filesystem::path& drive, const pipeline::AgentConfig& config, const FaultMaker& faults);

// The odometry alone, without an IMU, on a folder of clouds; body is the LiDAR.
OdometryRun RunClouds(const io::RecordingFolder& folder, const lio::LioConfig& config, Sweep sweep);

}  // namespace mapweld::odometry
