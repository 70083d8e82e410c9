// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace mapweld::serve {

// One drive: an agent between two starts. Its odometry has one frame. Agent 0: a recording that the store holds, with
// its key there as the epoch; nobody to ask or to tell.
struct DriveId {
  std::int16_t agent = 0;
  std::int32_t epoch = 0;
  auto operator<=>(const DriveId&) const = default;
};

// "agent_3", or "agent_3_boot_2" for later starts.
std::string DriveName(const DriveId& id);

}  // namespace mapweld::serve
