// SPDX-License-Identifier: Apache-2.0
// The relative-pose residual shared by the agent's local correction and the host's pose graph.
#pragma once

#include "core/geom/pose3.hpp"

namespace mapweld::geom {

struct BetweenLinearization {
  Vec6d residual;    // LocalCoordinates(measured a_T_b, estimated a_T_b): metres, then radians
  Mat6d jacobian_a;  // d residual / d right perturbation of world_T_a
  Mat6d jacobian_b;  // d residual / d right perturbation of world_T_b
};

BetweenLinearization LinearizeBetween(const Pose3& world_T_a, const Pose3& world_T_b, const Pose3& measured_a_T_b);
Vec6d BetweenResidual(const Pose3& world_T_a, const Pose3& world_T_b, const Pose3& measured_a_T_b);

}  // namespace mapweld::geom
