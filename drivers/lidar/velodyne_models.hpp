// SPDX-License-Identifier: Apache-2.0
// Layout of a Velodyne data packet and, per model, the geometry and timing of its lasers.
// Source: the user manuals of VLP-16, HDL-32E and VLP-32C: packet structure, firing sequence, vertical angle tables.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mapweld::lidar {

// 12 blocks of 32 returns each: one firing of 32 lasers, or two of 16.
struct VelodynePacket {
  static constexpr std::size_t kPayloadBytes = 1206;
  static constexpr std::size_t kBlocks = 12;
  static constexpr std::size_t kBlockBytes = 100;
  static constexpr std::size_t kReturns = 32;          // per block: u16 distance, u8 intensity
  static constexpr std::size_t kTimeAt = 1200;         // u32, us past the hour, of the first firing
  static constexpr std::size_t kModeAt = 1204;         // return mode
  static constexpr std::size_t kModelAt = 1205;        // sensor model
  static constexpr std::uint16_t kBlockFlag = 0xEEFF;  // bytes FF EE, read little-endian
  static constexpr std::uint8_t kStrongest = 0x37;
  static constexpr std::uint8_t kLast = 0x38;
  static constexpr std::uint8_t kDual = 0x39;  // blocks in pairs: last return, then strongest
  static constexpr std::uint16_t kTurnCdeg = 36000;
};
static_assert(VelodynePacket::kBlocks * VelodynePacket::kBlockBytes == VelodynePacket::kTimeAt);
static_assert(4 + VelodynePacket::kReturns * 3 == VelodynePacket::kBlockBytes);

struct VelodyneModel {
  std::uint8_t model_byte;
  std::uint8_t lasers;          // 16 or 32
  std::uint8_t lasers_at_once;  // that fire at the same moment
  std::int64_t laser_period_ps;
  std::int64_t firing_period_ps;  // all lasers and the recharge
  double distance_unit_m;
  // By laser number, which is also the firing order.
  std::array<double, VelodynePacket::kReturns> elevation_deg;
  std::array<double, VelodynePacket::kReturns> azimuth_deg;  // offset from the block's azimuth
};

inline constexpr VelodyneModel kVlp16{
    .model_byte = 0x22,
    .lasers = 16,
    .lasers_at_once = 1,
    .laser_period_ps = 2'304'000,
    .firing_period_ps = 55'296'000,
    .distance_unit_m = 0.002,
    .elevation_deg = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15},
    .azimuth_deg = {},
};

inline constexpr VelodyneModel kHdl32e{
    .model_byte = 0x21,
    .lasers = 32,
    .lasers_at_once = 1,
    .laser_period_ps = 1'152'000,
    .firing_period_ps = 46'080'000,
    .distance_unit_m = 0.002,
    .elevation_deg = {-30.67, -9.33,  -29.33, -8.00,  -28.00, -6.67,  -26.67, -5.33,  -25.33, -4.00,  -24.00,
                      -2.67,  -22.67, -1.33,  -21.33, 0.00,   -20.00, 1.33,   -18.67, 2.67,   -17.33, 4.00,
                      -16.00, 5.33,   -14.67, 6.67,   -13.33, 8.00,   -12.00, 9.33,   -10.67, 10.67},
    .azimuth_deg = {},
};

inline constexpr VelodyneModel kVlp32c{
    .model_byte = 0x28,
    .lasers = 32,
    .lasers_at_once = 2,
    .laser_period_ps = 2'304'000,
    .firing_period_ps = 55'296'000,
    .distance_unit_m = 0.004,
    .elevation_deg = {-25.0,  -1.0,   -1.667, -15.639, -11.31, 0.0,    -0.667, -8.843, -7.254, 0.333,  -0.333,
                      -6.148, -5.333, 1.333,  0.667,   -4.0,   -4.667, 1.667,  1.0,    -3.667, -3.333, 3.333,
                      2.333,  -2.667, -3.0,   7.0,     4.667,  -2.333, -2.0,   15.0,   10.333, -1.333},
    .azimuth_deg = {1.4, -4.2, 1.4, -1.4, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 4.2, -1.4,
                    1.4, -4.2, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4, 1.4, -1.4, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4},
};

}  // namespace mapweld::lidar
