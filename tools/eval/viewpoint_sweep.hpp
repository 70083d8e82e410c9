// SPDX-License-Identifier: Apache-2.0
// How much a descriptor minds being looked at from elsewhere: revisits are described again as if the vehicle had been
// turned and had driven further to the left, and looked up among the unchanged keyframes. After Fig. 9 and 10 of the
// AutoMerge paper (doi 10.1109/TRO.2023.3290448).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tools/describe/keyframe_source.hpp"
#include "tools/merge/progress.hpp"

namespace mapweld::eval {

inline constexpr std::array<double, 5> kSweepYaws_deg = {0, 15, 30, 90, 180};
inline constexpr std::array<double, 5> kSweepLefts_m = {0, 1, 2, 3, 4};
// Submaps made from scans reach this much further, so that a moved one is as full as the others.
inline constexpr double kSweepMargin_m = 5;

struct SweepScore {
  std::string variant;
  int queries = 0;
  // Recall@1 within 10 m of the moved place: [yaw][left].
  std::array<std::array<double, kSweepLefts_m.size()>, kSweepYaws_deg.size()> recall{};
};

struct SweepConfig {
  std::vector<std::string> variants;
  int most_queries = 300;  // more revisits than that are thinned evenly
  int threads = 0;
};

// Sources as for PlaceSet::AddSession: the same revisits as `mapweld eval places`. Cost: 25 descriptions a query, one
// description a keyframe and 25 distances per query and candidate, for each variant.
std::vector<SweepScore> SweepViewpoints(const std::vector<describe::KeyframeSource>& sources, const SweepConfig& config,
                                        merge::Progress* progress);

// The points as seen from `left` (m, in the frame of the cloud) and turned by `yaw_rad`: cut at the radius of a submap
// and made anew into one point per voxel. What was hidden from the true path stays hidden.
std::vector<Eigen::Vector3f> SeenFrom(const merge::SubmapCloud& cloud, const Eigen::Vector2f& left, double yaw_rad);

}  // namespace mapweld::eval
