// SPDX-License-Identifier: Apache-2.0
// The relative pose of two submaps, to a decimetre or so, from a first guess within a few metres and degrees.
//
// Each sampled point of b is drawn to its nearest point of a; the distance counts by the shape found around that point
// (as in generalized ICP: Segal, Haehnel, Thrun, RSS 2009, with the shape of the target only). Gauss-Newton with a
// Geman-McClure kernel and a gate that shrinks. Both frames are level, so tilt is held near zero.
#pragma once

#include <algorithm>
#include <span>

#include "core/geom/pose3.hpp"
#include "tools/merge/prepared_submap.hpp"

namespace mapweld::merge {

struct RegistrationConfig {
  double first_gate_m = 2.5;
  double last_gate_m = 1.0;
  int iterations = 25;              // per gate
  double tilt_sigma_rad = 0.03;     // how level two submaps of one place are
  double kernel_sigma = 2.0;        // of the Geman-McClure kernel, in standard deviations of the shapes
  double partner_distance_m = 0.5;  // closer than this, two points are the same thing
  double decoy_distance_m = 8;      // how far away chance is measured, also at half of this
};

struct Registration {
  geom::Pose3 a_T_b;
  bool converged = false;
  // Shares of structure points that found a partner, among those where the other submap has seen anything at all.
  double overlap_of_a = 0;
  double overlap_of_b = 0;
  double chance = 0;  // the greatest overlap_of_b when b is displaced: along a bare street as great as here
  int covered = 0;    // structure samples of a and b, together, that could have found a partner
  double covered_share = 0;
  double torn_share = 1;  // of the 8 m blocks of ground that both have seen: where next to nothing finds a partner
  double residual_m = 0;  // rms distance of partners across the shapes
  geom::Mat6d information = geom::Mat6d::Zero();  // right perturbation of a_T_b; of the shapes, not of the noise
  // Least and greatest eigenvalue of the horizontal part, per partner: small least = free to slide along a street.
  double slide_ratio = 0;

  [[nodiscard]] double Overlap() const { return std::min(overlap_of_a, overlap_of_b); }
  // Overlap above what chance gives, 0..1. A plain difference: on a bare street both are near 1, and that must count
  // for nothing.
  [[nodiscard]] double Evidence() const { return std::max(0.0, Overlap() - chance); }
};

// Cost: about 5 ms for submaps of 10 k points. Never fails: an answer that is no good shows in its numbers.
Registration Register(const PreparedSubmap& a, const PreparedSubmap& b, const geom::Pose3& guess_a_T_b,
                      const RegistrationConfig& config);

// The same from the best of several guesses: all take the first, cheap steps, the one whose overlap is greatest then
// takes the others. Cost: about 1.5 ms per guess, and 4 ms. No guess: not converged.
Registration RegisterBest(const PreparedSubmap& a, const PreparedSubmap& b, std::span<const geom::Pose3> guesses_a_T_b,
                          const RegistrationConfig& config);

// guess with its height replaced by the median difference of the lowest points under a common cell.
geom::Pose3 WithGroundHeight(const PreparedSubmap& a, const PreparedSubmap& b, const geom::Pose3& guess_a_T_b);

}  // namespace mapweld::merge
