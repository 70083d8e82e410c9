// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/base/time.hpp"

namespace mapweld::can {

// One classic CAN frame as received, whatever it came through.
struct CanFrame {
  TimeNs receive;         // monotonic in a live port, recorded time in a replayed one
  std::uint32_t id = 0;   // 11 or 29 bits, flags removed; of an error frame: the error class bits
  bool extended = false;  // 29-bit identifier
  bool remote = false;    // a request, carries no data
  bool error = false;     // made by the controller, not received from the bus
  bool stamped = false;   // `receive` is the kernel's or the recorder's stamp, not the time of reading
  bool gap = false;       // frames may have been lost right before this one
  std::uint8_t dlc = 0;   // 0..8
  std::array<std::uint8_t, 8> data{};
};

}  // namespace mapweld::can
