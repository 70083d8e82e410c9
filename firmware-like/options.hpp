// SPDX-License-Identifier: Apache-2.0
// What the agent is told at start. Everything that can change at run time of the fleet is here; what fixes memory is in
// core/config/capacity.hpp.
#pragma once

#include <cstdint>

#include "core/pipeline/agent_pipeline.hpp"
#include "drivers/can/xsens_ids.hpp"

namespace mapweld::executive {

// How the two sensors' clocks relate.
enum class TimeSource : std::uint8_t {
  kShared,   // one synchronised clock (PPS, PTP, a simulator): stamps are only unwrapped
  kReceive,  // free running: mapped to the receive clock by an estimator
};

enum class LidarModel : std::uint8_t { kVlp16, kHdl32e, kVlp32c, kXt32, kOs1 };

struct Options {
  int agent_id = 0;
  const char* can_interface = nullptr;  // one of these two
  const char* candump_path = nullptr;
  can::XsensIds imu_ids;
  bool imu_ids_given = false;
  const char* imu_dbc_path = nullptr;  // null: an Xsens MTi
  const char* imu_signals = nullptr;   // with imu_dbc_path: six names, see DbcImuCodec
  LidarModel lidar_model = LidarModel::kVlp16;
  const char* lidar_calibration_path = nullptr;  // needed by kOs1, possible with kXt32
  std::uint16_t lidar_port = 0;                  // 0 until parsed: the model's own
  const char* lcm_url = "udpm://239.255.76.67:7667?ttl=0";
  const char* state_dir = nullptr;  // boot epoch and spool
  std::int64_t spool_bytes = 256LL << 20;
  std::int64_t answer_bytes_per_s = 1'000'000;  // for submaps and repeated keyframes
  TimeSource time_source = TimeSource::kShared;
  pipeline::AgentConfig agent;
};

enum class ParseOutcome : std::uint8_t { kRun, kHelp, kVersion, kError };

// Reads the command line; on kError one sentence is in `message`. No heap.
struct ParsedOptions {
  ParseOutcome outcome = ParseOutcome::kError;
  Options options;
  char message[256] = {};
};
ParsedOptions ParseOptions(int argc, char** argv);

// The text of --help.
extern const char kHelpText[];

}  // namespace mapweld::executive
