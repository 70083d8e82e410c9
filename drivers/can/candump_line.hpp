// SPDX-License-Identifier: Apache-2.0
// One line of a `candump -L` log: "(1436509052.249713) can0 034#00FF01020304". Remote ("#R"), extended (8 digits) and
// error frames are read; CAN FD ("##") is refused with kVersion, anything else that is not such a line with kBadInput.
#pragma once

#include <string_view>

#include "core/base/status.hpp"
#include "drivers/can/can_frame.hpp"

namespace mapweld::can {

// `interface` is a view into `line`. The frame's receive time is the recorded one.
Status ParseCandumpLine(std::string_view line, CanFrame* frame, std::string_view* interface);

}  // namespace mapweld::can
