// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace mapweld::odometry {

void AddOdometryCommand(CLI::App& app);

}  // namespace mapweld::odometry
