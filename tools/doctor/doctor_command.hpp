// SPDX-License-Identifier: Apache-2.0
// mapweld doctor [--can IFACE] [--imu-hz N] [--imu-ids LIST | --imu-dbc FILE --imu-signals NAMES] [--lcm-url URL]
//                [--lidar-port P] [--state-dir DIR] [--spool-mib N] [--json]
#pragma once

#include <CLI/CLI.hpp>

namespace mapweld::doctor {

// The callback throws CLI::RuntimeError(1) when a check failed.
void AddDoctorCommand(CLI::App& app);

}  // namespace mapweld::doctor
