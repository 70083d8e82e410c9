// SPDX-License-Identifier: Apache-2.0
// Which matches belong together: neighbours in both drives make a cluster; RANSAC keeps those of a cluster that one
// rigid, level transform explains, tested by edge lengths first (eq. 7). What it leaves out may form zones of its own.
#pragma once

#include <vector>

#include "tools/merge/alignment.hpp"

namespace mapweld::merge {

struct Zone {
  std::vector<PlacedMatch> matches;  // best first; all agree with `alignment`
  Alignment alignment;
  double score = 0;
};

// Eq. 7 with an absolute slack: edges between keyframes 5 m apart are too short for a ratio. True when the lengths
// agree by ratio or within the slack.
bool EdgesAgree(double edge_a_m, double edge_b_m, const ZoneConfig& config);

// Best first: at most config.max_zones, and those at the ends of the drives whatever their score. Deterministic: a
// fixed seed per zone.
std::vector<Zone> FindZones(const Drive& a, const Drive& b, const std::vector<Match>& matches,
                            const ZoneConfig& config);

// Can one transform explain both, given what odometry does between them?
bool Agree(const Zone& x, const Zone& y, const ZoneConfig& config);

}  // namespace mapweld::merge
