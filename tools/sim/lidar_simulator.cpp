// SPDX-License-Identifier: Apache-2.0
#include "tools/sim/lidar_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/sim/hash_noise.hpp"

namespace mapweld::sim {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr std::int64_t kRevolution_ns = 100'000'000;

// Sine and cosine of the lasers' elevations.
struct Elevation {
  std::array<float, Vlp16::kLasers> sine;
  std::array<float, Vlp16::kLasers> cosine;
};

Elevation MakeElevation() {
  Elevation e{};
  for (std::size_t i = 0; i < Vlp16::kLasers; ++i) {
    const double angle = Vlp16::kElevation_deg[i] * std::numbers::pi / 180;
    e.sine[i] = static_cast<float>(std::sin(angle));
    e.cosine[i] = static_cast<float>(std::cos(angle));
  }
  return e;
}

// Time since the sensor last looked forward.
std::int64_t AngleTime_ns(std::int64_t past_hour_ns) {
  return past_hour_ns % kRevolution_ns;
}

// World pose of the lidar over one packet: linear between its ends. Over 1.3 ms a vehicle's true motion differs from
// that by less than a micrometre at the sensor and a tenth of a millimetre at 100 m.
struct MovingPose {
  Matrix3f rotation_begin, rotation_change;
  Vector3f position_begin, position_change;
};

MovingPose PoseOver(const VehicleMotion& motion, const geom::Pose3& body_T_lidar, double t_begin, double t_end) {
  const geom::Pose3 a = motion.WorldFromBody(t_begin) * body_T_lidar;
  const geom::Pose3 b = motion.WorldFromBody(t_end) * body_T_lidar;
  const geom::Mat3d rotation_a = a.q.toRotationMatrix();
  const geom::Mat3d change = b.q.toRotationMatrix() - rotation_a;
  return {rotation_a.cast<float>(), change.cast<float>(), a.t.cast<float>(), (b.t - a.t).cast<float>()};
}

}  // namespace

Vlp16Return DetectReturn(const LidarModel& model, Surface surface, std::uint32_t patch, double distance_m,
                         double cos_incidence, std::uint64_t random_bits) {
  constexpr double kHalfSignal = 5e-6;
  constexpr double kLostAnyway = 0.003;
  const Reflectance& kind = kReflectance[static_cast<std::size_t>(surface)];
  const std::uint64_t of_patch = Hash(patch, static_cast<std::uint64_t>(surface), 0xFACE);
  const double rho = std::clamp(kind.mean + kind.spread * Uniform(of_patch, -1, 1), 0.02, 1.0);
  const double signal = rho * cos_incidence / std::max(distance_m * distance_m, 0.01);
  const double seen = signal * signal / (signal * signal + kHalfSignal * kHalfSignal) - kLostAnyway;
  if (Uniform(Mix(random_bits + 1)) >= seen) return {};
  const double measured_m = distance_m + model.range_sigma_m * Gaussian(random_bits);
  const double units = std::clamp(std::round(measured_m / Vlp16::kDistanceUnit_m), 1.0, 65535.0);
  const double reflectivity = std::clamp(std::round(100 * rho + 3 * Gaussian(Mix(random_bits + 2))), 1.0, 100.0);
  return {static_cast<std::uint16_t>(units), static_cast<std::uint8_t>(reflectivity)};
}

template <class Visit>
void LidarSimulator::Fire(std::int64_t index, const Visit& visit) const {
  static const Elevation elevation = MakeElevation();
  const std::int64_t begin_ns = index * Vlp16::kPacketPeriod_ns;
  const auto seconds = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-9; };
  const MovingPose pose =
      PoseOver(motion_, model_.body_T_lidar, seconds(begin_ns), seconds(begin_ns + Vlp16::kPacketPeriod_ns));
  RayPacket rays;
  for (std::size_t sequence = 0; sequence < Vlp16::kSequences; ++sequence) {
    const std::int64_t sequence_ns = static_cast<std::int64_t>(sequence) * Vlp16::kSequencePeriod_ns;
    const std::int64_t angle_ns = AngleTime_ns(start_past_hour_ns_ + begin_ns + sequence_ns);
    for (std::size_t laser = 0; laser < Vlp16::kLasers; ++laser) {
      const std::int64_t laser_ns = static_cast<std::int64_t>(laser) * Vlp16::kLaserPeriod_ns;
      const auto azimuth = static_cast<float>(2 * std::numbers::pi * static_cast<double>(angle_ns + laser_ns) /
                                              static_cast<double>(kRevolution_ns));
      const float share = static_cast<float>(sequence_ns + laser_ns) / static_cast<float>(Vlp16::kPacketPeriod_ns);
      // The manual's x is right and y forward; ours is x forward, y left.
      const Vector3f along_lidar(elevation.cosine[laser] * std::cos(azimuth),
                                 -elevation.cosine[laser] * std::sin(azimuth), elevation.sine[laser]);
      const Vector3f along = pose.rotation_begin * along_lidar + share * (pose.rotation_change * along_lidar);
      const Vector3f origin = pose.position_begin + share * pose.position_change;
      rays.origin_x[laser] = origin.x();
      rays.origin_y[laser] = origin.y();
      rays.origin_z[laser] = origin.z();
      rays.direction_x[laser] = along.x();
      rays.direction_y[laser] = along.y();
      rays.direction_z[laser] = along.z();
    }
    caster_.Cast(rays, model_.max_range_m);
    for (std::size_t laser = 0; laser < Vlp16::kLasers; ++laser) {
      if (rays.distance_m[laser] <= 0) continue;
      const auto ray_number = static_cast<std::uint64_t>(index) * 1024 + sequence * Vlp16::kLasers + laser;
      const Vlp16Return measured =
          DetectReturn(model_, rays.surface[laser], rays.patch[laser], static_cast<double>(rays.distance_m[laser]),
                       static_cast<double>(rays.cos_incidence[laser]), Hash(seed_, ray_number));
      if (measured.distance_2mm == 0) continue;
      visit(sequence, laser, measured, Vector3f(rays.origin_x[laser], rays.origin_y[laser], rays.origin_z[laser]),
            Vector3f(rays.direction_x[laser], rays.direction_y[laser], rays.direction_z[laser]));
    }
  }
}

Vlp16Packet LidarSimulator::Packet(std::int64_t index) const {
  const std::int64_t begin_ns = start_past_hour_ns_ + index * Vlp16::kPacketPeriod_ns;
  Vlp16Packet packet;
  packet.us_past_hour = static_cast<std::uint32_t>(begin_ns / 1000 % 3'600'000'000);
  for (std::size_t block = 0; block < Vlp16::kBlocks; ++block) {
    const auto sequence = static_cast<std::int64_t>(block * Vlp16::kSequencesPerBlock);
    const std::int64_t angle_ns = AngleTime_ns(begin_ns + sequence * Vlp16::kSequencePeriod_ns);
    packet.azimuth_cdeg[block] =
        static_cast<std::uint16_t>((angle_ns * 36000 + kRevolution_ns / 2) / kRevolution_ns % 36000);
  }
  Fire(index, [&](std::size_t sequence, std::size_t laser, const Vlp16Return& measured, const Vector3f&,
                  const Vector3f&) { packet.returns[sequence][laser] = measured; });
  return packet;
}

void LidarSimulator::AppendPoints(std::int64_t index, std::vector<Vector3f>* world_points) const {
  Fire(index,
       [&](std::size_t, std::size_t, const Vlp16Return& measured, const Vector3f& origin, const Vector3f& direction) {
         const auto distance_m = static_cast<float>(measured.distance_2mm * Vlp16::kDistanceUnit_m);
         world_points->push_back(origin + distance_m * direction);
       });
}

}  // namespace mapweld::sim
