// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/city_graph.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "tests/bench/street_walk.hpp"

namespace mapweld::bench {
namespace {

using geom::Pose3;
using geom::Vec3d;

constexpr double kLoopReach_m = 4;

// Of every other drive the nearest pose within reach of pose i; of its own only where it comes back.
std::map<int, int> Partners(const CityGraph& city, const std::map<std::pair<int, int>, std::vector<int>>& cells, int i,
                            Dice* dice) {
  constexpr int kComesBack = 50;
  const Vec3d& at = city.truth[static_cast<std::size_t>(i)].t;
  std::map<int, int> nearest;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      const auto cell = cells.find({static_cast<int>(std::floor(at.x() / 10)) + dx,  //
                                    static_cast<int>(std::floor(at.y() / 10)) + dy});
      if (cell == cells.end()) continue;
      for (const int k : cell->second) {
        if (k <= i + kComesBack) continue;
        const auto distance = [&](int node) {
          return (city.truth[static_cast<std::size_t>(node)].t - at).head<2>().norm();
        };
        if (distance(k) >= kLoopReach_m || dice->Uniform() >= 0.4) continue;
        const auto [best, first] = nearest.emplace(city.drive_of[static_cast<std::size_t>(k)], k);
        if (!first && distance(k) < distance(best->second)) best->second = k;
      }
    }
  }
  return nearest;
}

}  // namespace

CityGraph MakeCity(const CityConfig& config) {
  constexpr double kOdometry_m = 0.03;
  constexpr double kOdometry_rad = 0.0015;
  constexpr double kLoop_m = 0.1;
  constexpr double kLoop_rad = 0.01;
  Dice dice(config.seed);
  CityGraph city;
  auto& nodes = city.graph.world_T_node;
  const geom::Mat6d odometry = pose_graph::InformationOf(Sigma(kOdometry_m, kOdometry_rad));
  const geom::Mat6d loop = pose_graph::InformationOf(Sigma(kLoop_m, kLoop_rad));
  for (int drive = 0; drive < config.drives; ++drive) {
    const std::vector<Pose3> way = WalkStreets(config.poses, config.blocks, &dice);
    for (std::size_t k = 0; k < way.size(); ++k) {
      const int node = static_cast<int>(nodes.size());
      if (k == 0) {
        nodes.push_back(drive == 0 ? way[0] : way[0] * dice.Noise(1, 0.01));
      } else {
        const Pose3 step = way[k - 1].Inverse() * way[k] * dice.Noise(kOdometry_m, kOdometry_rad);
        city.graph.edges.push_back({node - 1, node, step, odometry, 1});
        nodes.push_back(nodes.back() * step);
      }
      city.truth.push_back(way[k]);
      city.drive_of.push_back(drive);
    }
  }
  std::map<std::pair<int, int>, std::vector<int>> cells;
  for (std::size_t i = 0; i < city.truth.size(); ++i) {
    const Vec3d& at = city.truth[i].t;
    cells[{static_cast<int>(std::floor(at.x() / 10)), static_cast<int>(std::floor(at.y() / 10))}].push_back(
        static_cast<int>(i));
  }
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
    for (const auto& [drive, k] : Partners(city, cells, i, &dice)) {
      const Pose3 exact = city.truth[static_cast<std::size_t>(i)].Inverse() * city.truth[static_cast<std::size_t>(k)];
      city.graph.edges.push_back({i, k, exact * dice.Noise(kLoop_m, kLoop_rad), loop, 1});
      ++city.loops;
    }
  }
  return city;
}

}  // namespace mapweld::bench
