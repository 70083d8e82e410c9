// SPDX-License-Identifier: Apache-2.0
// Layout of a VLP-16 data packet and the geometry and timing of its lasers.
// Source: VLP-16 user manual, packet structure, firing sequence and vertical angle tables.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mapweld::lidar {

struct Vlp16 {
  static constexpr std::size_t kPayloadBytes = 1206;
  static constexpr std::size_t kBlocks = 12;
  static constexpr std::size_t kBlockBytes = 100;
  static constexpr std::size_t kFiringsPerBlock = 2;
  static constexpr std::size_t kLasers = 16;
  static constexpr std::size_t kTimeAt = 1200;         // u32, us past the hour, of the first firing
  static constexpr std::size_t kModeAt = 1204;         // return mode
  static constexpr std::size_t kModelAt = 1205;        // sensor model
  static constexpr std::uint16_t kBlockFlag = 0xEEFF;  // bytes FF EE, read little-endian
  static constexpr std::uint8_t kStrongest = 0x37;
  static constexpr std::uint8_t kLast = 0x38;
  static constexpr std::uint8_t kDual = 0x39;  // blocks in pairs: last return, then strongest
  static constexpr std::uint8_t kModelVlp16 = 0x22;
  static constexpr std::uint16_t kTurnCdeg = 36000;
  static constexpr double kDistanceUnitM = 0.002;
  static constexpr std::int64_t kLaserPeriodPs = 2'304'000;    // from one laser to the next
  static constexpr std::int64_t kFiringPeriodPs = 55'296'000;  // 16 lasers and the recharge
};
static_assert(Vlp16::kBlocks * Vlp16::kBlockBytes == Vlp16::kTimeAt);
static_assert(4 + Vlp16::kFiringsPerBlock * Vlp16::kLasers * 3 == Vlp16::kBlockBytes);

// Elevation in degrees by laser number, which is also the firing order.
inline constexpr std::array<int, Vlp16::kLasers> kVlp16ElevationDeg{-15, 1, -13, 3,  -11, 5,  -9, 7,
                                                                    -7,  9, -5,  11, -3,  13, -1, 15};

// Beam number counted from the lowest: elevations are 2 degrees apart.
constexpr std::uint16_t Vlp16Ring(std::size_t laser) {
  return static_cast<std::uint16_t>((kVlp16ElevationDeg[laser] + 15) / 2);
}
static_assert(Vlp16Ring(0) == 0 && Vlp16Ring(15) == 15 && Vlp16Ring(1) == 8 && Vlp16Ring(14) == 7);

}  // namespace mapweld::lidar
