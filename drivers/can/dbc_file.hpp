// SPDX-License-Identifier: Apache-2.0
// Reads signals out of a CAN database (.dbc). The subset: message lines (BO_) and their signal lines (SG_); everything
// else is skipped. Multiplexed signals (m.. or M after the name) are refused. No heap; one pass over the text per
// signal.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/status.hpp"
#include "drivers/can/can_frame.hpp"

namespace mapweld::can {

// Where a number lies in a frame and what it means: value = raw * factor + offset, in `unit`.
struct DbcSignal {
  std::uint32_t id = 0;  // of the message, without flags
  bool extended = false;
  std::uint8_t dlc = 0;     // of the message, 1..8
  std::uint8_t start = 0;   // bit number as the file has it: of the lowest bit (Intel) or the highest (Motorola)
  std::uint8_t length = 0;  // 1..32 bits
  bool big_endian = false;  // Motorola
  bool is_signed = false;
  double factor = 1;
  double offset = 0;
  std::string_view unit;  // a view into the text
};

// kEmpty: no such signal, or more than one; kBadInput: its lines are not of the subset, or it does not fit its message.
Status FindDbcSignal(std::string_view dbc, std::string_view name, DbcSignal* signal);

// frame.dlc must be the signal's.
double DbcValue(const DbcSignal& signal, const CanFrame& frame);

}  // namespace mapweld::can
