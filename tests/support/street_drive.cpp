// SPDX-License-Identifier: Apache-2.0
#include "tests/support/street_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/voxel_key.hpp"

namespace mapweld::test {
namespace {

constexpr double kPacketS = 0.1 / 75;
constexpr int kColumnsPerPacket = 24;
constexpr int kBeams = 16;
constexpr double kRampMs2 = 1.5;
constexpr double kWaveLengthM = 60;
constexpr float kReachM = 60;
const geom::Pose3 kBodyTLidar{{0.10, 0.0, 0.35}, geom::Quatd::Identity()};

double PathLength(double t_s, const StreetDriveConfig& config) {
  const double t = std::max(0.0, t_s - config.rest_s);
  const double ramp = config.speed_m_s / kRampMs2;
  // A smooth start: acceleration follows half a sine.
  if (t >= ramp) return 0.5 * config.speed_m_s * ramp + config.speed_m_s * (t - ramp);
  return 0.5 * config.speed_m_s * (t - ramp / std::numbers::pi * std::sin(std::numbers::pi * t / ramp));
}

}  // namespace

StreetDrive::StreetDrive(const StreetDriveConfig& config) : config_(config) {}

// The street never ends: what stands on it follows from the number of each 14 m of it.
void StreetDrive::BuildAround(float x) {
  constexpr float kBlockM = 14;
  const auto block = static_cast<std::int64_t>(std::floor(x / kBlockM));
  if (!boxes_.empty() && block == built_around_) return;
  built_around_ = block;
  boxes_.clear();
  const auto add = [this](const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
    (void)boxes_.TryPush({low, high});
  };
  add({x - 200, -200, -1.9F}, {x + 200, 200, -1.85F});  // ground
  if (config_.surroundings == Surroundings::kOpenField) return;
  if (config_.surroundings == Surroundings::kCorridor || config_.surroundings == Surroundings::kTunnel) {
    add({x - 200, 6, -1.9F}, {x + 200, 7, 8});
    add({x - 200, -7, -1.9F}, {x + 200, -6, 8});
    if (config_.surroundings == Surroundings::kTunnel) add({x - 200, -7, 4}, {x + 200, 7, 5});
    return;
  }
  for (std::int64_t i = block - 6; i <= block + 6; ++i) {
    for (const float side : {-1.0F, 1.0F}) {
      const std::uint64_t h = HashKey(static_cast<std::uint64_t>(i + 100) * 2 + (side > 0 ? 1 : 0));
      const float depth = 8.0F + static_cast<float>(h % 5);
      const float begin = static_cast<float>(i) * kBlockM + static_cast<float>((h >> 8U) % 4);
      if (config_.surroundings == Surroundings::kCountryRoad) {
        add({begin, side * depth - 0.5F, -1.9F}, {begin + 1, side * depth + 0.5F, -0.4F});
        continue;
      }
      const float height = 4.0F + static_cast<float>((h >> 16U) % 8);
      const float near = side * depth;
      const float far = side * (depth + 9);
      add({begin, std::min(near, far), -1.9F}, {begin + 9, std::max(near, far), height});
      const float pole = begin + 11;
      add({pole, side * 5.5F - 0.15F, -1.9F}, {pole + 0.3F, side * 5.5F + 0.15F, 4});
    }
  }
}

geom::Pose3 StreetDrive::World(double t_s) const {
  const double s = PathLength(t_s, config_);
  const double k = 2 * std::numbers::pi / kWaveLengthM;
  geom::Pose3 pose;
  pose.t = {s, config_.weave_m * std::sin(k * s), 0};
  pose.q = Eigen::AngleAxisd(std::atan(config_.weave_m * k * std::cos(k * s)), geom::Vec3d::UnitZ());
  return pose;
}

geom::Pose3 StreetDrive::TruthAt(TimeNs t) const {
  return World(0).Inverse() * World(static_cast<double>(t.ns) * 1e-9);
}

double StreetDrive::PathAt(TimeNs t) const {
  return PathLength(static_cast<double>(t.ns) * 1e-9, config_);
}

sensor::ImuSample StreetDrive::Imu(double t_s) {
  constexpr double h = 1e-3;
  const geom::Pose3 before = World(t_s - h);
  const geom::Pose3 now = World(t_s);
  const geom::Pose3 after = World(t_s + h);
  sensor::ImuSample sample;
  sample.t = FromSeconds(t_s).ns >= 0 ? TimeNs{FromSeconds(t_s).ns} : TimeNs{};
  sample.gyro_body = geom::LogSo3((before.q.conjugate() * after.q).normalized()) / (2 * h);
  sample.accel_body = now.q.conjugate() * ((after.t - 2 * now.t + before.t) / (h * h) + geom::Vec3d(0, 0, 9.81));
  sample.gyro_body.z() += config_.gyro_bias_z + 0.002 * Noise();
  sample.accel_body.y() += config_.accel_bias_y;
  sample.accel_body.z() += config_.accel_bias_z + 0.02 * Noise();
  return sample;
}

double StreetDrive::Noise() {  // near-Gaussian: the sum of four uniform numbers
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    noise_state_ = HashKey(noise_state_ + 0x9E3779B97F4A7C15U);
    sum += static_cast<double>(noise_state_ >> 11U) * 0x1p-53 - 0.5;
  }
  return sum * std::sqrt(3.0);
}

// Boxes that the rays from `from` within half_width_rad of the heading may meet, seen from above: each is taken for the
// circle around it.
void StreetDrive::FindNearBoxes(const Eigen::Vector3f& from, double heading_rad, double half_width_rad) {
  near_boxes_.clear();
  for (const Box& box : boxes_) {
    const Eigen::Vector2f centre = 0.5F * (box.low + box.high).head<2>() - from.head<2>();
    const float radius = 0.5F * (box.high - box.low).head<2>().norm();
    const float distance = centre.norm();
    if (distance > kReachM + radius) continue;
    if (distance > radius) {
      const double off =
          std::remainder(static_cast<double>(std::atan2(centre.y(), centre.x())) - heading_rad, 2 * std::numbers::pi);
      if (std::abs(off) > half_width_rad + std::asin(static_cast<double>(radius / distance))) continue;
    }
    (void)near_boxes_.TryPush(box);
  }
}

float StreetDrive::Cast(const Eigen::Vector3f& from, const Eigen::Vector3f& direction) const {
  float nearest = kReachM;
  for (const Box& box : near_boxes_) {
    float enter = 0;
    float leave = nearest;
    for (int axis = 0; axis < 3; ++axis) {
      const float inverse = 1.0F / direction(axis);
      const float a = (box.low(axis) - from(axis)) * inverse;
      const float b = (box.high(axis) - from(axis)) * inverse;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter < leave && enter > 0) nearest = enter;
  }
  return nearest < kReachM ? nearest : 0;
}

bool StreetDrive::Next(sensor::LidarPacket* packet, FixedVector<sensor::ImuSample, 16>* samples) {
  const double t0 = static_cast<double>(packet_) * kPacketS;
  if (t0 >= config_.seconds) return false;
  samples->clear();
  while (static_cast<double>(imu_) / config_.imu_hz <= t0) {
    const double t_imu = static_cast<double>(imu_++) / config_.imu_hz;
    const sensor::ImuSample sample = Imu(t_imu);
    if (t_imu >= config_.imu_gap_from_s && t_imu < config_.imu_gap_to_s) continue;
    (void)samples->TryPush(sample);
  }
  packet->points.clear();
  packet->t = {FromSeconds(t0).ns + 1};
  packet->azimuth_first_cdeg = static_cast<std::uint16_t>((packet_ % 75) * 480);
  packet->azimuth_last_cdeg = static_cast<std::uint16_t>((packet_ % 75) * 480 + 460);
  const geom::Pose3 world_T_lidar_begin = World(t0) * kBodyTLidar;
  BuildAround(static_cast<float>(world_T_lidar_begin.t.x()));
  constexpr double kSweep = 2 * std::numbers::pi / 75;
  FindNearBoxes(world_T_lidar_begin.t.cast<float>(),
                geom::Yaw(world_T_lidar_begin.q) - (static_cast<double>(packet_ % 75) + 0.5) * kSweep, kSweep);
  for (int column = 0; column < kColumnsPerPacket; ++column) {
    const double t = t0 + column * kPacketS / kColumnsPerPacket;
    const geom::Pose3 world_T_lidar = World(t) * kBodyTLidar;
    const Eigen::Vector3f from = world_T_lidar.t.cast<float>();
    const double azimuth =
        (static_cast<double>(packet_ % 75) * kColumnsPerPacket + column) * 2 * std::numbers::pi / 1800;
    for (int beam = 0; beam < kBeams; ++beam) {
      const double elevation = (2 * beam - 15) * std::numbers::pi / 180;
      const geom::Vec3d ray(std::cos(elevation) * std::cos(azimuth) + 1e-7,
                            -std::cos(elevation) * std::sin(azimuth) + 1e-7, std::sin(elevation));
      const float range = Cast(from, (world_T_lidar.q * ray).cast<float>());
      if (range <= 0) continue;
      const Eigen::Vector3f p = (ray * (static_cast<double>(range) + config_.range_noise_m * Noise())).cast<float>();
      (void)packet->points.TryPush(
          {p.x(), p.y(), p.z(), 50, static_cast<std::int32_t>((t - t0) * 1e9), static_cast<std::uint16_t>(beam), 0});
    }
  }
  ++packet_;
  return true;
}

bool StreetDrive::Step(pipeline::AgentPipeline* agent) {
  if (!Next(&scratch_packet_, &scratch_samples_)) return false;
  for (const sensor::ImuSample& sample : scratch_samples_) agent->OnImu(sample);
  agent->OnPacket(scratch_packet_);
  return true;
}

}  // namespace mapweld::test
