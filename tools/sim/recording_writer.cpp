// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/recording_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "tools/sim/candump.hpp"
#include "tools/sim/ouster_encoder.hpp"
#include "tools/sim/output_file.hpp"
#include "tools/sim/pcap_writer.hpp"
#include "tools/sim/velodyne_encoder.hpp"

namespace mapweld::sim {
namespace {

std::int64_t ToNs(double seconds) {
  return std::llround(seconds * 1e9);
}

// One packet of the sensor's own format: its bytes, and how many of its beams came back.
using Packet = std::pair<std::vector<std::uint8_t>, std::int64_t>;

Packet FirePacket(const LidarSimulator& lidar, std::int64_t index, bool dual) {
  Packet packet;
  auto& [bytes, returns] = packet;
  if (IsOuster(lidar.model())) {
    bytes = EncodeOuster(lidar, index, &returns);
    return packet;
  }
  const VelodynePacket velodyne = FireVelodynePacket(lidar, index, dual);
  for (const auto& block : velodyne.returns) {
    for (const VelodyneReturn& r : block) returns += r.distance_2mm != 0 ? 1 : 0;
  }
  const auto encoded = EncodeVelodyne(velodyne);
  bytes.assign(encoded.begin(), encoded.end());
  return packet;
}

void WriteLidar(const RayCaster& caster, const VehicleMotion& motion, const Traffic* traffic, const DriveSpec& spec,
                const std::filesystem::path& dir, const std::function<void(double)>& progress, DriveCounts& counts) {
  const LidarSimulator lidar(caster, motion, traffic, spec.lidar, spec.weather, spec.start_past_hour_ns, spec.seed);
  PcapWriter pcap(dir / "lidar.pcap", IsOuster(spec.lidar) ? kOusterPort : kVelodynePort);
  const std::int64_t columns = PacketColumns(spec.lidar, spec.dual_return);
  const std::int64_t packets = ToNs(spec.duration_s) / spec.lidar.ColumnStart_ns(columns);
  constexpr std::int64_t kPerReport = 256;
  for (std::int64_t i = 0; i < packets; ++i) {
    const auto& [bytes, returns] = FirePacket(lidar, i, spec.dual_return);
    counts.returns += returns;
    pcap.Write(lidar.PastHour_ns((i + 1) * columns), bytes);
    if (i % kPerReport == 0) progress(static_cast<double>(i) / static_cast<double>(packets));
  }
  pcap.Close();
  counts.packets = packets;
  // In dual return mode two rays look for the two returns.
  counts.rays = packets * columns * static_cast<std::int64_t>(spec.lidar.beams.size()) * (spec.dual_return ? 2 : 1);
  if (IsOuster(spec.lidar)) {
    OutputFile metadata(dir / "lidar_metadata.json");
    metadata.Write(OusterMetadataJson(spec.lidar));
    metadata.Close();
  }
}

void WriteImu(const VehicleMotion& motion, const DriveSpec& spec, const std::filesystem::path& file,
              DriveCounts& counts) {
  constexpr std::int64_t kFrameOnBus_ns = 400'000;
  OutputFile out(file);
  const std::int64_t period_ns = ToNs(1 / spec.imu.rate_hz);
  const std::int64_t samples = ToNs(spec.duration_s) / period_ns;
  for (std::int64_t i = 0; i < samples; ++i) {
    const double t = static_cast<double>(i * period_ns) * 1e-9;
    const std::int64_t stamp_ns = spec.start_past_hour_ns + i * period_ns;
    const ImuError error = DrawImuError(spec.imu, spec.seed, static_cast<std::uint64_t>(i), t);
    const auto frames = EncodeXsens({static_cast<std::uint32_t>(stamp_ns / 100'000), static_cast<std::uint16_t>(i),
                                     motion.GyroBody(t) + error.gyro, motion.AccelBody(t) + error.accel});
    std::int64_t sent_ns = stamp_ns;
    for (const CanFrame& frame : frames) out.Write(CandumpLine(sent_ns += kFrameOnBus_ns, frame));
  }
  out.Close();
  counts.imu_samples = samples;
}

void WriteTruth(const VehicleMotion& motion, const DriveSpec& spec, const std::filesystem::path& file) {
  constexpr std::int64_t kPeriod_ns = 50'000'000;
  OutputFile out(file);
  for (std::int64_t t_ns = 0; t_ns <= ToNs(spec.duration_s); t_ns += kPeriod_ns) {
    const geom::Pose3 world_T_body = motion.WorldFromBody(static_cast<double>(t_ns) * 1e-9);
    const geom::Vec3d& p = world_T_body.t;
    const geom::Quatd& q = world_T_body.q;
    out.Write(fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n",
                          static_cast<double>(spec.start_past_hour_ns + t_ns) * 1e-9, p.x(), p.y(), p.z(), q.x(), q.y(),
                          q.z(), q.w()));
  }
  out.Close();
}

}  // namespace

std::int64_t PacketColumns(const LidarModel& model, bool dual) {
  if (IsOuster(model)) return dual ? 0 : kOusterColumns;
  return VelodyneColumns(model, dual);
}

double PacketBytesPerBeam(const LidarModel& model) {
  return IsOuster(model) ? 12.4 : 3.3;
}

DriveCounts WriteRecording(const RayCaster& caster, const VehicleMotion& motion, const Traffic* traffic,
                           const DriveSpec& spec, const std::filesystem::path& dir,
                           const std::function<void(double)>& progress) {
  DriveCounts counts;
  WriteLidar(caster, motion, traffic, spec, dir, progress, counts);
  WriteImu(motion, spec, dir / "imu.candump", counts);
  WriteTruth(motion, spec, dir / "truth.tum");
  progress(1);
  return counts;
}

}  // namespace mapweld::sim
