// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "tools/spy/traffic.hpp"

namespace mapweld::spy {

// What was seen and where, for people: a row per channel below its sender. `missed`: see LcmTap.
std::string TrafficTable(const TrafficReport& report, const std::string& lcm_url, std::uint64_t missed);

// The same for programs. Keys: docs/wire.md.
std::string TrafficJson(const TrafficReport& report, const std::string& lcm_url, std::uint64_t missed);

}  // namespace mapweld::spy
