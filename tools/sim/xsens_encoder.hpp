// SPDX-License-Identifier: Apache-2.0
// CAN frames of the Xsens MTi-600 series, big endian; identifiers and scales from the vendor's page on CAN messages.
// The five frames below make one sample. At 250 kbit/s, the sensor's default, they fill 33 to 40 % of the bus at 200 Hz
// and 66 to 79 % at 400 Hz, which leaves too little room; 400 Hz needs 500 kbit/s.
#pragma once

#include <array>
#include <cstdint>

#include "core/geom/so3.hpp"

namespace mapweld::sim {

struct CanFrame {
  std::uint32_t id = 0;  // 11 bits
  std::uint8_t length = 0;
  std::array<std::uint8_t, 8> data{};
};

struct Xsens {
  static constexpr std::uint32_t kSampleTime = 0x005;    // u32, 100 us
  static constexpr std::uint32_t kGroupCounter = 0x006;  // u16
  static constexpr std::uint32_t kStatusWord = 0x011;    // u32 bits
  static constexpr std::uint32_t kRateOfTurn = 0x032;    // 3 x i16, 2^-9 rad/s
  static constexpr std::uint32_t kAcceleration = 0x034;  // 3 x i16, 2^-8 m/s^2
  static constexpr std::size_t kFrames = 5;
  // Self-test passed, filter valid, clock locked to the pulse per second.
  static constexpr std::uint32_t kHealthy = 0x43;
};

struct XsensSample {
  std::uint32_t time_100us = 0;
  std::uint16_t counter = 0;
  geom::Vec3d gyro_body = geom::Vec3d::Zero();   // rad/s
  geom::Vec3d accel_body = geom::Vec3d::Zero();  // m/s^2
};

// In sending order. Values round to the nearest step; one beyond the range stops there and sets its clipping bits.
std::array<CanFrame, Xsens::kFrames> EncodeXsens(const XsensSample& sample);

}  // namespace mapweld::sim
