// SPDX-License-Identifier: Apache-2.0
#include "firmware-like/options.hpp"

#include <getopt.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace mapweld::executive {

const char kHelpText[] =
    "usage: mapweld-agent --agent-id N --state-dir DIR (--can IFACE | --candump FILE) [options]\n"
    "\n"
    "Turns LiDAR packets (UDP) and IMU frames (CAN) into odometry, submaps and place descriptors, and publishes them\n"
    "over LCM. Allocates nothing after start.\n"
    "\n"
    "  --agent-id N          1..32767, unique in the fleet\n"
    "  --state-dir DIR       keeps the boot count and the spool of unsent submaps\n"
    "  --can IFACE           SocketCAN interface with the IMU, for example can0\n"
    "  --candump FILE        read the IMU's frames from a `candump -L` log instead\n"
    "  --imu-ids LIST        the MTi's identifiers of SampleTime, GroupCounter, StatusWord, RateOfTurn, Acceleration, "
    "in\n"
    "                        hexadecimal, 3 digits or 8 for 29 bits (005,006,011,032,034; high rate: "
    "005,006,011,061,062)\n"
    "  --imu-dbc FILE        the IMU is not an Xsens MTi but described by this CAN database\n"
    "  --imu-signals NAMES   its turn rates x,y,z and accelerations x,y,z: six signal names, separated by commas\n"
    "  --lidar MODEL         vlp16, hdl32e, vlp32c, xt32 or os1 (vlp16)\n"
    "  --lidar-calibration FILE  os1: the sensor's metadata (JSON); xt32: its angle correction file (nominal angles)\n"
    "  --lidar-port PORT     UDP port of the LiDAR's data packets (2368; os1: 7502)\n"
    "  --lcm-url URL         LCM network (environment LCM_DEFAULT_URL, else udpm://239.255.76.67:7667?ttl=0)\n"
    "  --time shared|receive clocks of LiDAR and IMU are synchronised, or run free (shared)\n"
    "  --lidar-at X,Y,Z,ROLL,PITCH,YAW  body_T_lidar, metres and degrees (0.10,0,0.35,0,0,0)\n"
    "  --spool-mib N         size of the spool file (256)\n"
    "  --answer-rate N       bytes per second at most for submaps and repeated keyframes (1000000)\n"
    "  --indoor              submaps of 20 m radius, released after 40 m\n"
    "  --version, --help\n"
    "\n"
    "exit codes: 0 ended on request, 2 wrong options, 3 a resource is missing (the message names it)\n";

namespace {

bool ParseNumber(const char* text, std::int64_t least, std::int64_t most, std::int64_t* out) {
  char* end = nullptr;
  errno = 0;
  const long long value = std::strtoll(text, &end, 10);
  if (errno != 0 || end == text || *end != '\0' || value < least || value > most) return false;
  *out = value;
  return true;
}

bool ParsePose(const char* text, geom::Pose3* pose) {
  double v[6];
  for (int i = 0; i < 6; ++i) {
    char* end = nullptr;
    v[i] = std::strtod(text, &end);
    if (end == text || !(v[i] > -1e3 && v[i] < 1e3) || *end != (i < 5 ? ',' : '\0')) return false;
    text = end + 1;
  }
  constexpr double kDegree = 3.14159265358979323846 / 180.0;
  pose->t = {v[0], v[1], v[2]};
  pose->q = Eigen::AngleAxisd(v[5] * kDegree, geom::Vec3d::UnitZ()) *
            Eigen::AngleAxisd(v[4] * kDegree, geom::Vec3d::UnitY()) *
            Eigen::AngleAxisd(v[3] * kDegree, geom::Vec3d::UnitX());
  return true;
}

bool ParseLidarModel(const char* text, LidarModel* model) {
  constexpr struct {
    const char* name;
    LidarModel model;
  } kModels[] = {{"vlp16", LidarModel::kVlp16},
                 {"hdl32e", LidarModel::kHdl32e},
                 {"vlp32c", LidarModel::kVlp32c},
                 {"xt32", LidarModel::kXt32},
                 {"os1", LidarModel::kOs1}};
  for (const auto& known : kModels) {
    if (std::strcmp(text, known.name) != 0) continue;
    *model = known.model;
    return true;
  }
  return false;
}

std::uint16_t DefaultPort(LidarModel model) {
  return model == LidarModel::kOs1 ? 7502 : 2368;
}

// Which models read a calibration file, and which cannot do without.
const char* LidarCalibrationProblem(const Options& options) {
  const bool given = options.lidar_calibration_path != nullptr;
  if (options.lidar_model == LidarModel::kOs1) {
    return given ? nullptr : "--lidar os1 needs --lidar-calibration, the sensor's metadata";
  }
  return given && options.lidar_model != LidarModel::kXt32 ? "--lidar-calibration is for os1 and xt32 only" : nullptr;
}

const char* ImuDescriptionProblem(const Options& options) {
  if ((options.imu_dbc_path == nullptr) != (options.imu_signals == nullptr))
    return "--imu-dbc and --imu-signals go together";
  if (options.imu_dbc_path != nullptr && options.imu_ids_given) return "--imu-ids is for an MTi, --imu-dbc for others";
  const bool clockless = options.imu_dbc_path != nullptr && options.time_source == TimeSource::kShared;
  return clockless ? "--imu-dbc needs --time receive: such an IMU has no clock of its own" : nullptr;
}

enum OptionId : int {
  kAgentId = 1000,
  kStateDir,
  kCan,
  kCandump,
  kImuIds,
  kImuDbc,
  kImuSignals,
  kLidar,
  kLidarCalibration,
  kLidarPort,
  kLcmUrl,
  kTime,
  kLidarAt,
  kSpoolMib,
  kAnswerRate,
  kIndoor,
  kVersionOption,
  kHelpOption,
};

constexpr option kOptions[] = {
    {"agent-id", required_argument, nullptr, kAgentId},
    {"state-dir", required_argument, nullptr, kStateDir},
    {"can", required_argument, nullptr, kCan},
    {"candump", required_argument, nullptr, kCandump},
    {"imu-ids", required_argument, nullptr, kImuIds},
    {"imu-dbc", required_argument, nullptr, kImuDbc},
    {"imu-signals", required_argument, nullptr, kImuSignals},
    {"lidar", required_argument, nullptr, kLidar},
    {"lidar-calibration", required_argument, nullptr, kLidarCalibration},
    {"lidar-port", required_argument, nullptr, kLidarPort},
    {"lcm-url", required_argument, nullptr, kLcmUrl},
    {"time", required_argument, nullptr, kTime},
    {"lidar-at", required_argument, nullptr, kLidarAt},
    {"spool-mib", required_argument, nullptr, kSpoolMib},
    {"answer-rate", required_argument, nullptr, kAnswerRate},
    {"indoor", no_argument, nullptr, kIndoor},
    {"version", no_argument, nullptr, kVersionOption},
    {"help", no_argument, nullptr, kHelpOption},
    {nullptr, 0, nullptr, 0},
};

// One option; false when its value is wrong.
bool Apply(int id, const char* value, Options* options) {
  std::int64_t number = 0;
  switch (id) {
    case kAgentId:
      if (!ParseNumber(value, 1, 32767, &number)) return false;
      options->agent_id = static_cast<int>(number);
      return true;
    case kStateDir:
      options->state_dir = value;
      return true;
    case kCan:
      options->can_interface = value;
      return true;
    case kCandump:
      options->candump_path = value;
      return true;
    case kImuIds:
      options->imu_ids_given = true;
      return can::XsensIds::Parse(value, &options->imu_ids) == Status::kOk;
    case kImuDbc:
      options->imu_dbc_path = value;
      return true;
    case kImuSignals:
      options->imu_signals = value;
      return true;
    case kLidar:
      return ParseLidarModel(value, &options->lidar_model);
    case kLidarCalibration:
      options->lidar_calibration_path = value;
      return true;
    case kLidarPort:
      if (!ParseNumber(value, 1, 65535, &number)) return false;
      options->lidar_port = static_cast<std::uint16_t>(number);
      return true;
    case kLcmUrl:
      options->lcm_url = value;
      return true;
    case kTime:
      if (std::strcmp(value, "shared") != 0 && std::strcmp(value, "receive") != 0) return false;
      options->time_source = value[0] == 's' ? TimeSource::kShared : TimeSource::kReceive;
      return true;
    case kLidarAt:
      return ParsePose(value, &options->agent.lio.body_T_lidar);
    case kSpoolMib:
      if (!ParseNumber(value, 1, 1 << 20, &number)) return false;
      options->spool_bytes = number << 20;
      return true;
    case kAnswerRate:
      return ParseNumber(value, 2000, 1'000'000'000, &options->answer_bytes_per_s);
    case kIndoor:
      pipeline::UseIndoors(&options->agent);
      return true;
    default:
      return false;
  }
}

}  // namespace

ParsedOptions ParseOptions(int argc, char** argv) {
  ParsedOptions parsed;
  if (const char* url = std::getenv("LCM_DEFAULT_URL"); url != nullptr && url[0] != '\0') parsed.options.lcm_url = url;
  const auto fail = [&](const char* format, const char* what) {
    std::snprintf(parsed.message, sizeof(parsed.message), format, what);
    parsed.outcome = ParseOutcome::kError;
    return parsed;
  };
  opterr = 0;
  optind = 1;
  for (;;) {
    int index = 0;
    const int id = getopt_long(argc, argv, "", kOptions, &index);
    if (id == -1) break;
    if (id == '?') return fail("unknown option or missing value: '%s' (see --help)", argv[optind - 1]);
    if (id == kHelpOption || id == kVersionOption) {
      parsed.outcome = id == kHelpOption ? ParseOutcome::kHelp : ParseOutcome::kVersion;
      return parsed;
    }
    if (!Apply(id, optarg, &parsed.options)) {
      std::snprintf(parsed.message, sizeof(parsed.message), "--%s does not accept '%s' (see --help)",
                    kOptions[index].name, optarg);
      return parsed;
    }
  }
  if (optind < argc) return fail("unexpected argument '%s' (see --help)", argv[optind]);
  if (parsed.options.agent_id == 0) return fail("%s is missing (see --help)", "--agent-id");
  if (parsed.options.state_dir == nullptr) return fail("%s is missing (see --help)", "--state-dir");
  if ((parsed.options.can_interface == nullptr) == (parsed.options.candump_path == nullptr)) {
    return fail("%s: give one of them, the IMU's frames must come from somewhere (see --help)", "--can, --candump");
  }
  if (const char* problem = LidarCalibrationProblem(parsed.options); problem != nullptr) {
    return fail("%s (see --help)", problem);
  }
  if (const char* problem = ImuDescriptionProblem(parsed.options); problem != nullptr) {
    return fail("%s (see --help)", problem);
  }
  if (parsed.options.lidar_port == 0) parsed.options.lidar_port = DefaultPort(parsed.options.lidar_model);
  parsed.outcome = ParseOutcome::kRun;
  return parsed;
}

}  // namespace mapweld::executive
