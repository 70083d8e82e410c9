// SPDX-License-Identifier: Apache-2.0
// The data packet of Velodyne's VLP-16 and HDL-32E, as their user manuals describe it: 12 blocks of 32 returns, one
// firing of 32 lasers or two of 16 in each. In dual return mode the blocks come in pairs of one firing: the last
// return, and the strongest or, where that is the last, the second strongest; with at most two returns that is the
// nearer one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tools/sim/lidar_simulator.hpp"

namespace mapweld::sim {

struct VelodyneReturn {
  std::uint16_t distance_2mm = 0;  // 0: no return
  std::uint8_t reflectivity = 0;   // 0..100 diffuse
};

struct VelodynePacket {
  static constexpr std::size_t kBlocks = 12;
  static constexpr std::size_t kReturnsPerBlock = 32;
  static constexpr std::size_t kPayloadBytes = 1206;
  static constexpr std::uint8_t kStrongestReturn = 0x37;
  static constexpr std::uint8_t kDualReturn = 0x39;
  static constexpr std::uint8_t kVlp16 = 0x22;
  static constexpr std::uint8_t kHdl32e = 0x21;
  static constexpr double kDistanceUnit_m = 0.002;

  std::uint32_t us_past_hour = 0;  // first firing
  std::uint8_t mode = kStrongestReturn;
  std::uint8_t model = kVlp16;
  std::array<std::uint16_t, kBlocks> azimuth_cdeg{};  // first firing of each block, 0..35999, clockwise from forward
  std::array<std::array<VelodyneReturn, kReturnsPerBlock>, kBlocks> returns{};  // in firing order
};

// Columns in a packet of this LiDAR: 24 or 12, half of it in dual return mode; 0 when it is none of the two.
std::int64_t VelodyneColumns(const LidarModel& model, bool dual = false);

// Packet `index` holds the columns from index * VelodyneColumns on.
VelodynePacket FireVelodynePacket(const LidarSimulator& lidar, std::int64_t index, bool dual = false);

inline constexpr std::uint16_t kVelodynePort = 2368;

std::array<std::uint8_t, VelodynePacket::kPayloadBytes> EncodeVelodyne(const VelodynePacket& packet);

}  // namespace mapweld::sim
