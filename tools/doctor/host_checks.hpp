// SPDX-License-Identifier: Apache-2.0
// The machine: its clock, what the agent is permitted to do, its state directory.
#pragma once

#include <cstdint>
#include <string>

#include "tools/doctor/finding.hpp"

namespace mapweld::doctor {

// `current` and `available`: the kernel's clock sources; `read_ns`: what one reading of the time costs.
Finding CheckClockSource(const std::string& current, const std::string& available, double read_ns);
Finding CheckClockSource();

// Whether memory may be locked, so that a page fault cannot stall the odometry.
Finding CheckMemoryLock(std::uint64_t agent_bytes);

// Writable, holds a boot count or none yet, room for the spool.
Finding CheckStateDirectory(const std::string& path, std::uint64_t spool_bytes);

}  // namespace mapweld::doctor
