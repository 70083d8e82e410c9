// SPDX-License-Identifier: Apache-2.0
// A town around paths that somebody really drove: streets where they run, houses of a suburb beside them.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/sim/scenario.hpp"
#include "tools/sim/survey.hpp"
#include "tools/sim/town.hpp"

namespace mapweld::sim {

struct PathTown {
  Town town;
  // One per path; each a zone of its own, 3 km apart, unless the plan says that they lie in one frame.
  std::vector<SurveyedDrive> drives;
};

// Reads rows of twelve numbers, the 3 x 4 pose of KITTI's left camera (x and z are the plane), or of eight, a TUM
// trajectory (x and y are the plane); lines that begin with # are remarks. Heights are left out. Throws
// std::runtime_error that says where the data may be had when a file is missing, and for one without poses.
PathTown BuildPathTown(const PathPlan& plan, std::uint64_t seed);

}  // namespace mapweld::sim
