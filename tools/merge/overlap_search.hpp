// SPDX-License-Identifier: Apache-2.0
// From one verified pair of keyframes to a verified overlap of two drives: the relative pose is carried along both
// drives by odometry, and at every step the submaps must agree again. A look-alike place fails after a few steps; a
// true overlap collects evidence until the drives part.
#pragma once

#include <string>
#include <vector>

#include "tools/merge/look_alikes.hpp"
#include "tools/merge/loop_finder.hpp"
#include "tools/merge/merge_result.hpp"
#include "tools/merge/zones.hpp"

namespace mapweld::merge {

struct Hypothesis {
  std::vector<VerifiedLoop> loops;  // the seed first
  int near_pairs = 0;               // pairs that must agree if the hypothesis holds, and were tried
  int contradictions = 0;           // those that did not
  double overlap = 0;               // sum of their overlap ratios
  double torn = 0;                  // sum of their torn shares
  int missing = 0;                  // steps that could not be tried for want of a submap
  double evidence = 0;              // sum over the loops
  std::string test;                 // empty: accepted; else the test that refused it
};

// Carries the seed along both drives.
Hypothesis Extend(LoopFinder* finder, const VerifiedLoop& seed, const VerifyConfig& config);

// Do the drives agree by clearly more than any of the places compared resembles other places of its own drive?
bool StandsOut(const Hypothesis& hypothesis, LookAlikes* look_alikes, const VerifyConfig& config);

// All that one pair of drives has in common. Tries the zones best first; the hypothesis with the most evidence wins,
// later ones are added where odometry allows both. `test` names what refused the one that came furthest.
Hypothesis FindOverlap(LoopFinder* finder, LookAlikes* look_alikes, const std::vector<Zone>& zones,
                       const VerifyConfig& config);

// Metres of drive a along which b is near, at least one keyframe spacing when there is a loop.
double SharedLength(const Drive& a, const std::vector<Loop>& loops, const VerifyConfig& config);

}  // namespace mapweld::merge
