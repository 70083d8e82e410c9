// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/zones.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

namespace mapweld::merge {
namespace {

using Matches = std::vector<PlacedMatch>;

double TurnBetween(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, 2 * std::numbers::pi));
}

// Single-link clusters in the plane of (keyframe of a, keyframe of b).
std::vector<Matches> Cluster(const Matches& matches, int gap) {
  std::vector<int> label(matches.size(), -1);
  std::vector<Matches> clusters;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (label[i] >= 0) continue;
    const int cluster = static_cast<int>(clusters.size());
    clusters.emplace_back();
    std::vector<std::size_t> open{i};
    label[i] = cluster;
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      for (std::size_t k = 0; k < matches.size(); ++k) {
        if (label[k] >= 0) continue;
        if (std::abs(matches[k].match.a - matches[at].match.a) > gap) continue;
        if (std::abs(matches[k].match.b - matches[at].match.b) > gap) continue;
        label[k] = cluster;
        open.push_back(k);
      }
    }
    for (std::size_t k = 0; k < matches.size(); ++k) {
      if (label[k] == cluster) clusters.back().push_back(matches[k]);
    }
  }
  return clusters;
}

bool EdgesAgree(const PlacedMatch& x, const PlacedMatch& y, const ZoneConfig& config) {
  return mapweld::merge::EdgesAgree((x.odom_a_T_level.t - y.odom_a_T_level.t).norm(),
                                    (x.odom_b_T_level.t - y.odom_b_T_level.t).norm(), config);
}

bool Fits(const Alignment& alignment, const PlacedMatch& m, const ZoneConfig& config) {
  const geom::Vec3d off = m.odom_a_T_level.t - alignment.a_T_b * m.odom_b_T_level.t;
  const double yaw_rad = geom::Yaw(alignment.a_T_b.q) - geom::Yaw(m.odom_a_T_level.q) + geom::Yaw(m.odom_b_T_level.q);
  return off.norm() < config.position_slack_m && TurnBetween(yaw_rad, m.yaw_rad) < config.yaw_slack_rad;
}

// The largest set found that agrees with one alignment; at least one match.
Matches Ransac(const Matches& matches, const ZoneConfig& config) {
  std::mt19937 random(20230704);
  Matches best;
  double best_score = -1;
  const auto consider = [&](const Matches& sample) {
    const Alignment alignment = Align(sample, {});
    Matches inliers;
    double score = 0;
    for (const PlacedMatch& m : matches) {
      if (!Fits(alignment, m, config)) continue;
      inliers.push_back(m);
      score += m.match.score;
    }
    if (score > best_score) {
      best_score = score;
      best = std::move(inliers);
    }
  };
  for (const PlacedMatch& m : matches) consider({m});
  if (matches.size() < 3) return best.empty() ? Matches{matches.front()} : best;
  for (int round = 0; round < config.ransac_rounds; ++round) {
    const auto pick = [&] { return matches[random() % matches.size()]; };
    const PlacedMatch x = pick();
    const PlacedMatch y = pick();
    const PlacedMatch z = pick();
    if (EdgesAgree(x, y, config) && EdgesAgree(y, z, config) && EdgesAgree(x, z, config)) consider({x, y, z});
  }
  return best.empty() ? Matches{matches.front()} : best;
}

}  // namespace

bool EdgesAgree(double edge_a_m, double edge_b_m, const ZoneConfig& config) {
  const bool by_ratio = edge_a_m >= config.edge_ratio * edge_b_m && edge_b_m >= config.edge_ratio * edge_a_m;
  return by_ratio || std::abs(edge_a_m - edge_b_m) <= config.edge_slack_m;
}

std::vector<Zone> FindZones(const Drive& a, const Drive& b, const std::vector<Match>& matches,
                            const ZoneConfig& config) {
  Matches placed;
  for (const Match& match : matches) placed.push_back(Place(a, b, match));
  std::vector<Zone> zones;
  for (Matches rest : Cluster(placed, config.zone_gap)) {
    while (!rest.empty()) {
      Zone zone;
      zone.matches = Ransac(rest, config);
      std::erase_if(rest, [&](const PlacedMatch& m) {
        return std::any_of(zone.matches.begin(), zone.matches.end(), [&](const PlacedMatch& taken) {
          return taken.match.a == m.match.a && taken.match.b == m.match.b && taken.match.reverse == m.match.reverse;
        });
      });
      std::stable_sort(zone.matches.begin(), zone.matches.end(),
                       [](const PlacedMatch& x, const PlacedMatch& y) { return x.match.score > y.match.score; });
      zone.alignment = Align(zone.matches, {});
      for (const PlacedMatch& m : zone.matches) zone.score += m.match.score;
      zones.push_back(std::move(zone));
    }
  }
  // Zones that tell the same story from different places support each other.
  std::vector<double> support(zones.size(), 0.0);
  for (std::size_t i = 0; i < zones.size(); ++i) {
    for (std::size_t k = 0; k < zones.size(); ++k) {
      if (i != k && Agree(zones[i], zones[k], config)) support[i] += 0.5 * zones[k].score;
    }
  }
  for (std::size_t i = 0; i < zones.size(); ++i) zones[i].score += support[i];
  std::stable_sort(zones.begin(), zones.end(), [](const Zone& x, const Zone& y) { return x.score > y.score; });
  std::vector<Zone> kept;
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const bool at_ends = std::any_of(zones[i].matches.begin(), zones[i].matches.end(),
                                     [](const PlacedMatch& m) { return m.match.ends; });
    if (static_cast<int>(i) < config.max_zones || at_ends) kept.push_back(std::move(zones[i]));
  }
  return kept;
}

bool Agree(const Zone& x, const Zone& y, const ZoneConfig& config) {
  const PlacedMatch& m = y.matches.front();
  const PlacedMatch& n = x.matches.front();
  const geom::Vec3d off = m.odom_a_T_level.t - x.alignment.a_T_b * m.odom_b_T_level.t;
  const double distance_m =
      (m.odom_a_T_level.t - n.odom_a_T_level.t).norm() + (m.odom_b_T_level.t - n.odom_b_T_level.t).norm();
  const double turn_rad = TurnBetween(geom::Yaw(x.alignment.a_T_b.q), geom::Yaw(y.alignment.a_T_b.q));
  const double slack_m = config.position_slack_m + (config.drift + x.alignment.yaw_sigma_rad) * distance_m;
  return off.norm() < slack_m && turn_rad < config.yaw_slack_rad;
}

}  // namespace mapweld::merge
