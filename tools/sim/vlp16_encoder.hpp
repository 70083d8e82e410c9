// SPDX-License-Identifier: Apache-2.0
// The Velodyne VLP-16's data packet, as its user manual (63-9243, chapters 6 and 9) describes it: timing, angles,
// bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mapweld::sim {

struct Vlp16 {
  static constexpr std::size_t kLasers = 16;
  static constexpr std::size_t kBlocks = 12;
  static constexpr std::size_t kSequencesPerBlock = 2;
  static constexpr std::size_t kSequences = kBlocks * kSequencesPerBlock;  // per packet
  static constexpr std::size_t kPayloadBytes = 1206;
  static constexpr std::int64_t kLaserPeriod_ns = 2304;
  static constexpr std::int64_t kSequencePeriod_ns = 55296;
  static constexpr std::int64_t kPacketPeriod_ns = kSequencePeriod_ns * static_cast<std::int64_t>(kSequences);
  static constexpr std::uint8_t kStrongestReturn = 0x37;
  static constexpr std::uint8_t kModel = 0x22;
  static constexpr double kDistanceUnit_m = 0.002;
  // In firing order.
  static constexpr std::array<int, kLasers> kElevation_deg{-15, 1, -13, 3,  -11, 5,  -9, 7,
                                                           -7,  9, -5,  11, -3,  13, -1, 15};
};

struct Vlp16Return {
  std::uint16_t distance_2mm = 0;  // 0: no return
  std::uint8_t reflectivity = 0;   // 0..100 diffuse
};

struct Vlp16Packet {
  std::uint32_t us_past_hour = 0;                            // first firing
  std::array<std::uint16_t, Vlp16::kBlocks> azimuth_cdeg{};  // first firing of each block, 0..35999, clockwise from +y
  std::array<std::array<Vlp16Return, Vlp16::kLasers>, Vlp16::kSequences> returns{};  // in firing order
};

std::array<std::uint8_t, Vlp16::kPayloadBytes> EncodeVlp16(const Vlp16Packet& packet);

}  // namespace mapweld::sim
