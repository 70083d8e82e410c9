// SPDX-License-Identifier: Apache-2.0
// One VLP-16 data packet (the 1206-byte UDP payload) into points in the lidar frame (x forward, y left, z up).
// The manual's frame has y forward and x right: x = r cos(w) sin(a), y = r cos(w) cos(a), z = r sin(w), so ours is
// (y, -x, z). Each laser gets its own azimuth, interpolated to its firing time; in dual return mode a second return
// equal to the first is given once. A packet is refused whole: no point comes from a packet that is wrong anywhere.
// Cost: at most 384 points, about 10 us. No heap.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/sensor/lidar_packet.hpp"
#include "drivers/lidar/vlp16_geometry.hpp"
#include "drivers/time/sensor_clock.hpp"

namespace mapweld::lidar {

static_assert(kCap.packet_points >= Vlp16::kBlocks * Vlp16::kFiringsPerBlock * Vlp16::kLasers);

class Vlp16Codec {
 public:
  // Faster than 1200 rpm (0.8 degrees per block) with room for jitter; a larger step between blocks is not rotation.
  static constexpr int kMaxStepCdeg = 120;

  struct Counters {
    std::uint64_t packets = 0;  // decoded
    std::uint64_t points = 0;
    std::uint64_t odd_steps = 0;  // azimuth steps that are not rotation, replaced by the step before
    // refused packets
    std::uint64_t wrong_size = 0;
    std::uint64_t wrong_flag = 0;     // a block does not start with FF EE
    std::uint64_t wrong_mode = 0;     // return mode unknown
    std::uint64_t wrong_model = 0;    // another sensor
    std::uint64_t wrong_azimuth = 0;  // 36000 or more
    std::uint64_t wrong_time = 0;     // more than an hour of microseconds, or a jump backwards
  };

  explicit Vlp16Codec(time::ClockMode clock_mode = time::ClockMode::kShared);

  // kBadInput, or the status of the clock for the time stamp; *packet is then empty.
  Status Decode(std::span<const std::uint8_t> payload, TimeNs receive, sensor::LidarPacket* packet);

  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] std::uint64_t Rejected() const;
  time::SensorClock& clock() { return clock_; }

 private:
  using Azimuths = std::array<std::uint16_t, Vlp16::kBlocks>;

  bool Check(std::span<const std::uint8_t> payload);
  bool ReadAzimuths(std::span<const std::uint8_t> payload, Azimuths* azimuth_cdeg);
  void DecodeBlock(std::span<const std::uint8_t> payload, std::size_t block, bool dual, double azimuth_cdeg,
                   double step_cdeg, sensor::LidarPacket* packet) const;

  time::SensorClock clock_;
  std::array<double, Vlp16::kLasers> cos_elevation_{};
  std::array<double, Vlp16::kLasers> sin_elevation_{};
  Counters counters_;
};

}  // namespace mapweld::lidar
