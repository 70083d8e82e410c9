// SPDX-License-Identifier: Apache-2.0
// One line of a CAN log as `candump -L` of can-utils writes it: (seconds.micros) can0 032#001122334455
#pragma once

#include <cstdint>
#include <string>

#include "tools/sim/xsens_encoder.hpp"

namespace mapweld::sim {

// With the line's end. The stamp rounds down to microseconds.
std::string CandumpLine(std::int64_t stamp_ns, const CanFrame& frame);

}  // namespace mapweld::sim
