// SPDX-License-Identifier: Apache-2.0
// Which identifiers the messages have that odometry needs: an MTi's can be changed, and be 11 or 29 bits long.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/base/status.hpp"
#include "drivers/can/can_frame.hpp"
#include "drivers/can/xsens_table.hpp"

namespace mapweld::can {

class XsensIds {
 public:
  static constexpr std::size_t kCount = 5;
  static constexpr std::uint32_t kExtendedFlag = 0x8000'0000;  // as the kernel marks 29-bit identifiers

  // The device's own.
  XsensIds() = default;

  // kNone: the frame is none of them. Error and remote frames are not looked at differently.
  [[nodiscard]] XsensField FieldOf(const CanFrame& frame) const;

  // For the kernel's filter: SampleTime, GroupCounter, StatusWord, RateOfTurn, Acceleration.
  [[nodiscard]] const std::array<std::uint32_t, kCount>& all() const { return ids_; }

  // Five identifiers in the order of all(), separated by commas, in hexadecimal as can-utils writes them: three digits
  // for 11 bits, eight for 29. "005,006,011,061,062" takes the high-rate messages. kBadInput: anything else, or one
  // identifier twice.
  static Status Parse(std::string_view text, XsensIds* ids);

 private:
  std::array<std::uint32_t, kCount> ids_{kXsensWantedIds};
};

}  // namespace mapweld::can
