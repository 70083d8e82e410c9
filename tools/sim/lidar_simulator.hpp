// SPDX-License-Identifier: Apache-2.0
// A VLP-16 at 600 rpm on a moving vehicle: every beam leaves at its own moment from where the sensor is then.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geom/pose3.hpp"
#include "tools/sim/ray_caster.hpp"
#include "tools/sim/vehicle_motion.hpp"
#include "tools/sim/vlp16_encoder.hpp"

namespace mapweld::sim {

struct LidarModel {
  geom::Pose3 body_T_lidar{{0.10, 0, 0.35}, geom::Quatd::Identity()};
  float max_range_m = 100;
  double range_sigma_m = 0.02;
};

class LidarSimulator {
 public:
  // `start_past_hour_ns`: sensor time at t = 0 of the motion. The scan angle is locked to the second: 0 at whole
  // tenths.
  LidarSimulator(const RayCaster& caster, const VehicleMotion& motion, const LidarModel& model,
                 std::int64_t start_past_hour_ns, std::uint64_t seed)
      : caster_(caster), motion_(motion), model_(model), start_past_hour_ns_(start_past_hour_ns), seed_(seed) {}

  // Packet `index` begins index * Vlp16::kPacketPeriod_ns after the start. Depends on nothing but the index.
  [[nodiscard]] Vlp16Packet Packet(std::int64_t index) const;
  // The returns of the same packet as points in the world: what a perfect odometry would make of it.
  void AppendPoints(std::int64_t index, std::vector<Eigen::Vector3f>* world_points) const;

 private:
  // Fires all beams of one packet: visit(sequence, laser, return, origin, direction) for those that came back.
  template <class Visit>
  void Fire(std::int64_t index, const Visit& visit) const;

  const RayCaster& caster_;
  const VehicleMotion& motion_;
  LidarModel model_;
  std::int64_t start_past_hour_ns_;
  std::uint64_t seed_;
};

// What the receiver makes of a hit; the same random bits give the same return. Returns at long range, at grazing
// incidence or from dark surfaces get lost: detection probability s^2 / (s^2 + h^2) of signal s = rho cos(i) / r^2.
Vlp16Return DetectReturn(const LidarModel& model, Surface surface, std::uint32_t patch, double distance_m,
                         double cos_incidence, std::uint64_t random_bits);

}  // namespace mapweld::sim
