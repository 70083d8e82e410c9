// SPDX-License-Identifier: Apache-2.0
// What a run of the odometry is worth, in a few lines of text.
#pragma once

#include <string>
#include <vector>

#include "tools/io/tum.hpp"
#include "tools/odometry/odometry_run.hpp"

namespace mapweld::odometry {

std::vector<io::StampedPose> Trajectory(const OdometryRun& run);

// Errors against `truth` (world_T_body; empty: left out), time per scan, degenerate and uncorrected scans, submaps.
std::string Report(const OdometryRun& run, const std::vector<io::StampedPose>& truth);
// The same figures with one entry per scan, as JSON.
std::string ReportJson(const OdometryRun& run, const std::vector<io::StampedPose>& truth);

}  // namespace mapweld::odometry
