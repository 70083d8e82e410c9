// SPDX-License-Identifier: Apache-2.0
// One data packet of a Velodyne VLP-16, HDL-32E or VLP-32C (the 1206-byte UDP payload) into points.
// The manual's frame has y forward and x right: x = r cos(w) sin(a), y = r cos(w) cos(a), z = r sin(w), so ours is
// (y, -x, z). Each laser gets its own azimuth, interpolated to its firing time; in dual return mode a second return
// equal to the first is given once. Cost: at most 384 points, about 10 us. No heap.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "drivers/lidar/lidar_codec.hpp"
#include "drivers/lidar/velodyne_models.hpp"

namespace mapweld::lidar {

static_assert(kCap.packet_points >= VelodynePacket::kBlocks * VelodynePacket::kReturns);

class VelodyneCodec final : public LidarCodec {
 public:
  // Faster than 1200 rpm (0.8 degrees per block) with room for jitter; a larger step between blocks is not rotation.
  static constexpr int kMaxStepCdeg = 120;

  // `model` must outlive the codec: one of the constants of velodyne_models.hpp.
  explicit VelodyneCodec(const VelodyneModel& model, time::ClockMode clock_mode = time::ClockMode::kShared);

  // Beam counted from the lowest.
  [[nodiscard]] std::uint16_t ring(std::size_t laser) const { return beams_[laser].ring; }

 private:
  using Azimuths = std::array<std::uint16_t, VelodynePacket::kBlocks>;
  struct Beam {
    double cos_elevation = 1;
    double sin_elevation = 0;
    double azimuth_rad = 0;
    std::int64_t delay_ps = 0;  // after the start of its firing
    std::uint16_t ring = 0;
  };

  Status DecodeInto(std::span<const std::uint8_t> payload, TimeNs receive, sensor::LidarPacket* packet) override;
  Status Check(std::span<const std::uint8_t> payload);
  Status ReadAzimuths(std::span<const std::uint8_t> payload, Azimuths* azimuth_cdeg);
  void DecodeBlock(std::span<const std::uint8_t> payload, std::size_t block, bool dual, double azimuth_cdeg,
                   double step_cdeg, sensor::LidarPacket* packet) const;

  const VelodyneModel& model_;
  std::array<Beam, VelodynePacket::kReturns> beams_{};
};

}  // namespace mapweld::lidar
