// SPDX-License-Identifier: Apache-2.0
#include "tools/odometry/sensor_faults.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "core/base/voxel_key.hpp"
#include "core/geom/so3.hpp"

namespace mapweld::odometry {
namespace {

constexpr std::pair<const char*, FaultKind> kNames[] = {
    {"imu-gap", FaultKind::kImuGap},         {"imu-stuck", FaultKind::kImuStuck},
    {"imu-clipped", FaultKind::kImuClipped}, {"imu-bias", FaultKind::kImuBias},
    {"imu-late", FaultKind::kImuLate},       {"lidar-gap", FaultKind::kLidarGap},
    {"packet-loss", FaultKind::kPacketLoss}, {"tilted", FaultKind::kTilted},
    {"shifted", FaultKind::kShifted},        {"traffic", FaultKind::kTraffic}};

// A row of trucks in the neighbouring lane, at a constant speed against the vehicle.
struct TruckLane {
  double y_m;  // of the side that faces the vehicle
  double speed_m_s;
};
constexpr TruckLane kLanes[] = {{3.0, -14.0}, {-3.0, 2.5}};
constexpr double kTruckLength_m = 9;
constexpr double kTruckBottom_m = -1.6;  // under the LiDAR
constexpr double kTruckTop_m = 1.6;

// Where the ray to p meets a truck, as a share of |p|; 1 when it meets none.
double MeetTruck(const Eigen::Vector3d& p, double t_s, double spacing_m) {
  double nearest = 1;
  for (const TruckLane& lane : kLanes) {
    if (p.y() * lane.y_m <= 0) continue;
    const double share = lane.y_m / p.y();
    const double along = share * p.x() - lane.speed_m_s * t_s;
    const double height = share * p.z();
    const double within = along - spacing_m * std::floor(along / spacing_m);
    if (within < kTruckLength_m && height > kTruckBottom_m && height < kTruckTop_m) nearest = std::min(nearest, share);
  }
  return nearest;
}

class FaultySensors final : public SensorSink {
 public:
  FaultySensors(std::vector<Fault> faults, SensorSink* sink) : faults_(std::move(faults)), sink_(sink) {}

  void OnImu(const sensor::ImuSample& sample) override {
    if (!begin_) begin_ = sample.t;
    sensor::ImuSample out = sample;
    bool lost = false;
    for (const Fault& fault : faults_) Spoil(fault, Since(sample.t), &out, &lost);
    if (!lost) sink_->OnImu(out);
  }

  void OnPacket(const sensor::LidarPacket& packet) override {
    if (!begin_) begin_ = packet.t;
    packet_ = packet;
    bool lost = false;
    for (const Fault& fault : faults_) Spoil(fault, Since(packet.t), &packet_, &lost);
    if (!lost) sink_->OnPacket(packet_);
  }

 private:
  [[nodiscard]] double Since(TimeNs t) const { return (t - *begin_).Seconds(); }

  void Spoil(const Fault& fault, double now_s, sensor::ImuSample* sample, bool* lost) {
    const bool during = now_s >= fault.from_s && now_s < fault.from_s + fault.amount;
    if (fault.kind == FaultKind::kImuGap && during) *lost = true;
    if (fault.kind == FaultKind::kImuClipped && during) sample->clipped = true;
    if (fault.kind == FaultKind::kImuBias && now_s >= fault.from_s) sample->gyro_body.x() += fault.amount;
    if (fault.kind == FaultKind::kImuLate) sample->t = sample->t + FromSeconds(fault.amount * 1e-3);
    if (fault.kind != FaultKind::kImuStuck) return;
    if (!during) stuck_at_ = *sample;
    sample->gyro_body = stuck_at_.gyro_body;
    sample->accel_body = stuck_at_.accel_body;
  }

  void Spoil(const Fault& fault, double now_s, sensor::LidarPacket* packet, bool* lost) {
    if (now_s < fault.from_s) return;
    if (fault.kind == FaultKind::kLidarGap && now_s < fault.from_s + fault.amount) *lost = true;
    if (fault.kind == FaultKind::kPacketLoss) {
      const std::uint64_t draw = HashKey(static_cast<std::uint64_t>(packet->t.ns));
      if (static_cast<double>(draw % 10000) < fault.amount * 100) *lost = true;
    }
    const Eigen::AngleAxisd turn(fault.amount * std::numbers::pi / 180, geom::Vec3d::UnitY());
    // Two full lanes of trucks hide about 60 % of a VLP-16's points.
    const double spacing_m = kTruckLength_m * 60 / fault.amount;
    for (sensor::LidarPoint& point : packet->points) {
      geom::Vec3d p(point.x, point.y, point.z);
      if (fault.kind == FaultKind::kTilted) p = turn * p;
      if (fault.kind == FaultKind::kShifted) p.x() += fault.amount * 0.01;
      if (fault.kind == FaultKind::kTraffic) p *= MeetTruck(p, now_s + point.dt_ns * 1e-9, spacing_m);
      point.x = static_cast<float>(p.x());
      point.y = static_cast<float>(p.y());
      point.z = static_cast<float>(p.z());
    }
  }

  std::vector<Fault> faults_;
  SensorSink* sink_;
  std::optional<TimeNs> begin_;
  sensor::ImuSample stuck_at_;
  sensor::LidarPacket packet_;
};

}  // namespace

Fault ParseFault(const std::string& text) {
  const std::size_t first = text.find(':');
  const std::size_t second = text.find(':', first + 1);
  try {
    for (const auto& [name, kind] : kNames) {
      if (text.substr(0, first) != name || first == std::string::npos) continue;
      const double from_s = second == std::string::npos ? 0 : std::stod(text.substr(second + 1));
      return {kind, std::stod(text.substr(first + 1)), from_s};
    }
  } catch (const std::logic_error&) {  // stod: not a number; told below
  }
  std::string names;
  for (const auto& [name, kind] : kNames) names += fmt::format(" {}", name);
  throw std::runtime_error(fmt::format("'{}' is no fault; it takes NAME:AMOUNT[:SECONDS], with one of{}", text, names));
}

std::unique_ptr<SensorSink> MakeFaults(const std::vector<Fault>& faults, SensorSink* sink) {
  return std::make_unique<FaultySensors>(faults, sink);
}

}  // namespace mapweld::odometry
