// SPDX-License-Identifier: Apache-2.0
// What the odometry alone makes of a drive, from above: where its map is double, it has drifted.
#pragma once

#include <string>

#include "tools/odometry/odometry_run.hpp"

namespace mapweld::odometry {

// A PNG of all submaps where the odometry puts them, coloured by height, with the way driven; at most 2400 x 2400
// pixels. Throws when the run has no submap.
std::string MapPng(const OdometryRun& run);

}  // namespace mapweld::odometry
