// SPDX-License-Identifier: Apache-2.0
// Frames of an Xsens MTi, made for tests.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>

#include "drivers/can/can_frame.hpp"

namespace mapweld::can::test {

inline CanFrame Frame(std::uint32_t id, std::initializer_list<std::uint8_t> bytes, std::int64_t receive_ns = 0) {
  CanFrame frame;
  frame.id = id;
  frame.receive = {receive_ns};
  frame.stamped = receive_ns != 0;
  for (const std::uint8_t byte : bytes) frame.data[frame.dlc++] = byte;
  return frame;
}

inline CanFrame FrameU32(std::uint32_t id, std::uint32_t v, std::int64_t receive_ns = 0) {
  return Frame(id,
               {static_cast<std::uint8_t>(v >> 24U), static_cast<std::uint8_t>(v >> 16U),
                static_cast<std::uint8_t>(v >> 8U), static_cast<std::uint8_t>(v)},
               receive_ns);
}

inline CanFrame FrameAxes(std::uint32_t id, int x, int y, int z, std::int64_t receive_ns = 0) {
  const auto high = [](int v) { return static_cast<std::uint8_t>((static_cast<unsigned>(v) >> 8U) & 0xFFU); };
  const auto low = [](int v) { return static_cast<std::uint8_t>(static_cast<unsigned>(v) & 0xFFU); };
  return Frame(id, {high(x), low(x), high(y), low(y), high(z), low(z)}, receive_ns);
}

// One sample: the five frames in the order of the device, 0.3 ms apart.
struct GroupSpec {
  std::uint32_t ticks = 0;
  std::uint16_t counter = 0;
  std::uint32_t status = 0;
  std::array<int, 3> gyro{};
  std::array<int, 3> accel{0, 0, 2511};  // 9.81 m/s^2 on z
  std::int64_t receive_ns = 0;           // 0: no kernel stamp
};

inline std::array<CanFrame, 5> Group(const GroupSpec& g) {
  const auto at = [&](int i) { return g.receive_ns == 0 ? 0 : g.receive_ns + i * 300'000; };
  return {FrameU32(0x005, g.ticks, at(0)),
          Frame(0x006, {static_cast<std::uint8_t>(g.counter >> 8U), static_cast<std::uint8_t>(g.counter)}, at(1)),
          FrameU32(0x011, g.status, at(2)), FrameAxes(0x032, g.gyro[0], g.gyro[1], g.gyro[2], at(3)),
          FrameAxes(0x034, g.accel[0], g.accel[1], g.accel[2], at(4))};
}

}  // namespace mapweld::can::test
