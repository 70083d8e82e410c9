// SPDX-License-Identifier: Apache-2.0
// One data packet of a Hesai PandarXT-32 (UDP payload of 1080 bytes, protocol 6.1) into points.
//   12 bytes of header; 8 blocks of u16 azimuth (0.01 degrees) and 32 x {u16 distance, 4 mm; u8 reflectivity; u8};
//   tail with return mode, motor speed, date and time of day (UTC), microseconds, factory byte, packet number.
// The manual's frame has y forward and x right, as Velodyne's. The azimuth of a channel is that of its block plus the
// offset of the angle correction file; the nominal angles (15 .. -16 degrees, no offsets) are within 0.15 degrees.
// In dual return mode two blocks share one firing, and a second return equal to the first is given once.
// Cost: at most 256 points. No heap.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/lidar/beam_table.hpp"
#include "drivers/lidar/lidar_codec.hpp"

namespace mapweld::lidar {

struct HesaiXt32 {
  static constexpr std::size_t kPayloadBytes = 1080;
  static constexpr std::size_t kBlocks = 8;
  static constexpr std::size_t kChannels = 32;
  static constexpr std::size_t kBlocksAt = 12;
  static constexpr std::size_t kBlockBytes = 2 + 4 * kChannels;
  static constexpr std::size_t kModeAt = 1062;
  static constexpr std::size_t kDateAt = 1065;  // year - 1900, month, day, hour, minute, second; then u32 us
  static constexpr std::size_t kFactoryAt = 1075;
  static constexpr std::size_t kNumberAt = 1076;  // u32
  static constexpr double kDistanceUnitM = 0.004;
  static constexpr std::uint8_t kFactoryByte = 0x42;
  static constexpr std::int32_t kBlockPeriodNs = 50'000;
  static constexpr std::int32_t kLastBlockNs = 5'632;  // start of the last firing after the packet's time
  static constexpr std::int32_t kFirstChannelNs = 368;
  static constexpr std::int32_t kChannelPeriodNs = 1'512;
};
static_assert(kCap.packet_points >= HesaiXt32::kBlocks * HesaiXt32::kChannels);

class HesaiXt32Codec final : public LidarCodec {
 public:
  explicit HesaiXt32Codec(time::ClockMode clock_mode = time::ClockMode::kShared);

  // This sensor's own angles, of 32 beams.
  void SetAngles(const BeamTable& table);

 private:
  struct Beam {
    double cos_elevation = 1;
    double sin_elevation = 0;
    double azimuth_rad = 0;
    std::uint16_t ring = 0;
  };

  Status DecodeInto(std::span<const std::uint8_t> payload, TimeNs receive, sensor::LidarPacket* packet) override;
  Status Check(std::span<const std::uint8_t> payload);
  void CountLost(std::uint32_t number);
  void DecodeBlock(std::span<const std::uint8_t> payload, std::size_t block, std::size_t returns,
                   sensor::LidarPacket* packet) const;

  std::array<Beam, HesaiXt32::kChannels> beams_{};
  bool numbered_ = false;
  std::uint32_t last_number_ = 0;
};

}  // namespace mapweld::lidar
