// SPDX-License-Identifier: Apache-2.0
// Drives round a block of 100 m, for tests of solvers.
#pragma once

#include <random>
#include <vector>

#include "tools/pose_graph/pose_graph.hpp"

namespace mapweld::test {

class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  geom::Pose3 Of(const geom::Pose3& pose, const geom::Vec6d& sigma) {
    geom::Vec6d delta;
    for (int i = 0; i < 6; ++i) delta[i] = sigma[i] * normal_(random_);
    return geom::Retract(pose, delta);
  }
  double Uniform(double low, double high) { return low + (high - low) * static_cast<double>(random_() % 100000) / 1e5; }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

inline geom::Vec6d Sigma(double metres, double radians) {
  geom::Vec6d out;
  out << metres, metres, metres, radians, radians, radians;
  return out;
}

// 80 poses, 5 m apart.
inline std::vector<geom::Pose3> Block() {
  static const geom::Vec3d kCorners[] = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}};
  std::vector<geom::Pose3> out;
  for (int k = 0; k < 80; ++k) {
    const int side = k / 20;
    const double yaw_rad = side * 1.5707963;
    const geom::Vec3d along = geom::ExpSo3({0, 0, yaw_rad}) * geom::Vec3d(5.0 * (k % 20), 0, 0);
    out.push_back({kCorners[side] + along, geom::ExpSo3({0, 0, yaw_rad})});
  }
  return out;
}

inline pose_graph::Edge EdgeOf(const std::vector<geom::Pose3>& truth, int a, int b, const geom::Vec6d& sigma,
                               Noise* noise) {
  const geom::Pose3 exact = truth[static_cast<std::size_t>(a)].Inverse() * truth[static_cast<std::size_t>(b)];
  return {a, b, noise->Of(exact, sigma), pose_graph::InformationOf(sigma), 1};
}

// One drive round the block that comes back to where it began.
inline pose_graph::PoseGraph NoisyBlock(const std::vector<geom::Pose3>& truth) {
  Noise noise(4);
  pose_graph::PoseGraph graph;
  graph.world_T_node.push_back(truth[0]);
  for (int k = 0; k + 1 < static_cast<int>(truth.size()); ++k) {
    graph.edges.push_back(EdgeOf(truth, k, k + 1, Sigma(0.05, 0.01), &noise));
    graph.world_T_node.push_back(graph.world_T_node.back() * graph.edges.back().a_T_b);
  }
  graph.edges.push_back(EdgeOf(truth, static_cast<int>(truth.size()) - 1, 0, Sigma(0.05, 0.002), &noise));
  return graph;
}

inline double WorstError(const std::vector<geom::Pose3>& estimate, const std::vector<geom::Pose3>& truth) {
  double worst = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) worst = std::max(worst, (estimate[i].t - truth[i].t).norm());
  return worst;
}

}  // namespace mapweld::test
