// SPDX-License-Identifier: Apache-2.0
// The CAN interface: there, up, in good state, fast enough for what the IMU sends.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/doctor/can_load.hpp"
#include "tools/doctor/finding.hpp"

namespace mapweld::doctor {

struct CanLink {
  bool up = false;
  bool is_can = false;          // real or virtual
  std::string state;            // ERROR-ACTIVE ...; empty for a virtual one
  std::int64_t bitrate = 0;     // 0 when it has none: virtual, or never set
  std::int64_t restart_ms = 0;  // after bus-off; 0: never
  std::int64_t bus_off = 0;     // times since it was made
};

// From `ip -json -details -statistics link show dev NAME`; nothing when the list is empty.
std::optional<CanLink> ReadCanLink(const nlohmann::json& links);

std::vector<Finding> CheckCan(const std::string& interface, const std::optional<CanLink>& link,
                              const std::vector<CanMessage>& messages, double hz);

// Whether this kernel has CAN at all.
Finding CheckCanKernel();

}  // namespace mapweld::doctor
