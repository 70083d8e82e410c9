// SPDX-License-Identifier: Apache-2.0
// Closed-form alignment of two odometries from matched keyframes. Gravity is known in both, so four numbers are left:
// yaw and translation. Positions and the yaw of each single match both count, which keeps it determined when all
// matches lie on one spot. After Horn, "Closed-form solution of absolute orientation", 1987, reduced to the plane.
#pragma once

#include <vector>

#include "tools/merge/drive.hpp"
#include "tools/merge/merge_config.hpp"
#include "tools/merge/sequence_match.hpp"

namespace mapweld::merge {

// A match with the relative yaw of its two views: the heading of b in the level frame of a.
struct PlacedMatch {
  Match match;
  geom::Pose3 odom_a_T_level;  // of keyframe a
  geom::Pose3 odom_b_T_level;  // of keyframe b
  double yaw_rad = 0;
};

PlacedMatch Place(const Drive& a, const Drive& b, const Match& match);

struct Alignment {
  geom::Pose3 a_T_b;         // odom frame of b to odom frame of a: yaw and translation only
  double rms_m = 0;          // of the matches' positions
  double yaw_sigma_rad = 0;  // large: the matches do not determine the yaw
};

struct AlignmentNoise {
  double position_sigma_m = 3;
  double yaw_sigma_rad = 0.15;
};

// Needs at least one match. Linear in the number of matches.
Alignment Align(const std::vector<PlacedMatch>& matches, const AlignmentNoise& noise);

}  // namespace mapweld::merge
