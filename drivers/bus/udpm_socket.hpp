// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/bus/lcm_url.hpp"

namespace mapweld::bus {

// A non-blocking socket that hears the group of `address`, shared with the other LCM programs of this machine, with
// the kernel's stamps and loss counter (see drivers/time/receive_info.hpp). The descriptor, or -1 with errno.
int OpenUdpmReceiver(const UdpmAddress& address);

}  // namespace mapweld::bus
