// SPDX-License-Identifier: Apache-2.0
// What a merge says: which drives belong together, why, and where every keyframe is.
#pragma once

#include <string>
#include <vector>

#include "tools/merge/drive.hpp"

namespace mapweld::merge {

// One pair of keyframes that show the same place, tied by registration of their submaps.
struct Loop {
  int keyframe_a = 0;
  int keyframe_b = 0;
  geom::Pose3 a_T_b;         // level frame of b to level frame of a
  double overlap_ratio = 0;  // share of the smaller submap's points that found a partner, 0..1
  double residual_m = 0;     // rms point-to-plane distance of the partners
  double weight = 1;         // of the robust optimisation, 0..1
};

// Everything known about one pair of drives that association proposed, accepted or not.
struct Overlap {
  int drive_a = 0;  // drive_a < drive_b
  int drive_b = 0;
  bool accepted = false;
  std::string test;      // the test that decided: "registration", "overlap ratio", "too few matches", "cycle", ...
  bool reverse = false;  // driven in opposite directions
  geom::Pose3 a_T_b;     // odom frame of b to odom frame of a
  double length_m = 0;   // of the shared stretch
  double weight = 0;     // omega_ij (eq. 9)
  std::vector<std::pair<int, int>> matches;  // keyframes (a, b) that association proposed
  std::vector<Loop> loops;                   // those that registration confirmed
};

// uint8 image of the distance between every keyframe of a and of b: 0 = same, 255 = nothing in common.
struct DifferenceMatrix {
  int drive_a = 0;
  int drive_b = 0;
  int rows = 0;                        // keyframes of a
  int cols = 0;                        // keyframes of b
  std::vector<std::uint8_t> distance;  // row-major
};

struct StageTime {
  std::string stage;
  double seconds = 0;  // wall clock
};

struct MergeResult {
  std::vector<Overlap> overlaps;                        // sorted by (drive_a, drive_b)
  std::vector<std::vector<int>> groups;                 // drives, each sorted; largest group first, then lowest drive
  std::vector<int> group_of;                            // per drive
  std::vector<std::vector<geom::Pose3>> merged_T_body;  // per drive and keyframe, in the frame of the drive's group
  std::vector<DifferenceMatrix> differences;            // pairs with an overlap, for the report
  std::vector<SubmapKey> missing;                       // submaps that were wanted and not there; sorted
  std::vector<StageTime> times;
};

}  // namespace mapweld::merge
