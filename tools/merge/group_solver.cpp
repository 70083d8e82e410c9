// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/group_solver.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/merge/robust_solve.hpp"

namespace mapweld::merge {
namespace {

using geom::Pose3;
using geom::Vec6d;
using pose_graph::Edge;

geom::Mat6d InformationOf(double sigma_m, double sigma_tilt_rad, double sigma_yaw_rad) {
  Vec6d sigma;
  sigma << sigma_m, sigma_m, sigma_m, sigma_tilt_rad, sigma_tilt_rad, sigma_yaw_rad;
  return pose_graph::InformationOf(sigma);
}

// Errors of the odometry grow with the root of the path.
Edge OdometryEdge(const Keyframe& from, const Keyframe& to, int node, const GraphConfig& config) {
  constexpr double kStep_m = 5;
  const double growth = std::sqrt(std::clamp((to.path_m - from.path_m) / kStep_m, 0.2, 100.0));
  Edge edge;
  edge.a = node;
  edge.b = node + 1;
  edge.a_T_b = from.odom_T_body.Inverse() * to.odom_T_body;
  edge.information = InformationOf(config.odometry_sigma_m * growth, config.odometry_sigma_tilt_rad * growth,
                                   config.odometry_sigma_yaw_rad * growth);
  return edge;
}

Edge LoopEdge(const Keyframe& a, const Keyframe& b, const Loop& loop, int node_a, int node_b,
              const GraphConfig& config) {
  // From level frames to body frames.
  const Pose3 body_T_level_a = a.odom_T_body.Inverse() * geom::Level(a.odom_T_body);
  const Pose3 body_T_level_b = b.odom_T_body.Inverse() * geom::Level(b.odom_T_body);
  Edge edge;
  edge.a = node_a;
  edge.b = node_b;
  edge.a_T_b = body_T_level_a * loop.a_T_b * body_T_level_b.Inverse();
  edge.information = InformationOf(config.loop_sigma_m, config.loop_sigma_tilt_rad, config.loop_sigma_yaw_rad);
  return edge;
}

const Keyframe& KeyframeOf(const std::vector<Drive>& drives, int drive, int keyframe) {
  return drives[static_cast<std::size_t>(drive)].keyframes[static_cast<std::size_t>(keyframe)];
}

bool Counts(const Overlap& overlap, const std::vector<int>& group) {
  return overlap.accepted && std::binary_search(group.begin(), group.end(), overlap.drive_a) &&
         std::binary_search(group.begin(), group.end(), overlap.drive_b);
}

RobustConfig RobustConfigOf(const GraphConfig& config) {
  RobustConfig out;
  out.max_iterations = config.max_iterations;
  out.min_places = 1;  // registration and the walk along the overlap have verified every pair
  return out;
}

}  // namespace

GroupSolution SolveGroup(const std::vector<Drive>& drives, const std::vector<int>& group,
                         const std::vector<Overlap>& overlaps, const GraphConfig& config) {
  ChainGraph graph;
  std::map<int, int> first_node;
  for (std::size_t chain = 0; chain < group.size(); ++chain) {
    const Drive& drive = drives[static_cast<std::size_t>(group[chain])];
    first_node[group[chain]] = static_cast<int>(graph.chain_T_node.size());
    for (std::size_t k = 0; k < drive.keyframes.size(); ++k) {
      const int node = static_cast<int>(graph.chain_T_node.size());
      graph.chain_T_node.push_back(drive.keyframes[k].odom_T_body);
      graph.chain_of.push_back(static_cast<int>(chain));
      if (k + 1 < drive.keyframes.size()) {
        graph.odometry.push_back(OdometryEdge(drive.keyframes[k], drive.keyframes[k + 1], node, config));
      }
    }
  }
  for (const Overlap& overlap : overlaps) {
    if (!Counts(overlap, group)) continue;
    const int first_a = first_node[overlap.drive_a];
    const int first_b = first_node[overlap.drive_b];
    for (const Loop& loop : overlap.loops) {
      const Keyframe& keyframe_a = KeyframeOf(drives, overlap.drive_a, loop.keyframe_a);
      const Keyframe& keyframe_b = KeyframeOf(drives, overlap.drive_b, loop.keyframe_b);
      graph.loops.push_back(
          LoopEdge(keyframe_a, keyframe_b, loop, first_a + loop.keyframe_a, first_b + loop.keyframe_b, config));
    }
  }
  const RobustResult solved = SolveRobust(graph, RobustConfigOf(config));
  GroupSolution out;
  out.loop_weight = solved.loop_weight;
  for (const int drive : group) {
    const auto begin = solved.world_T_node.begin() + first_node[drive];
    out.merged_T_body.emplace_back(
        begin, begin + static_cast<std::ptrdiff_t>(drives[static_cast<std::size_t>(drive)].keyframes.size()));
  }
  return out;
}

void SetLoopWeights(const std::vector<int>& group, const GroupSolution& solution, std::vector<Overlap>* overlaps) {
  std::size_t next = 0;
  for (Overlap& overlap : *overlaps) {
    if (!Counts(overlap, group)) continue;
    for (Loop& loop : overlap.loops) loop.weight = solution.loop_weight[next++];
  }
}

std::size_t LoopsThatFit(const std::vector<Drive>& drives, const Overlap& overlap,
                         const std::vector<std::vector<Pose3>>& merged_T_body, const GraphConfig& config) {
  std::size_t fit = 0;
  for (const Loop& loop : overlap.loops) {
    const std::vector<Pose3> ends = {
        merged_T_body[static_cast<std::size_t>(overlap.drive_a)][static_cast<std::size_t>(loop.keyframe_a)],
        merged_T_body[static_cast<std::size_t>(overlap.drive_b)][static_cast<std::size_t>(loop.keyframe_b)]};
    const Edge edge = LoopEdge(KeyframeOf(drives, overlap.drive_a, loop.keyframe_a),
                               KeyframeOf(drives, overlap.drive_b, loop.keyframe_b), loop, 0, 1, config);
    fit += pose_graph::Chi2(ends, edge) <= RobustConfigOf(config).inlier_chi2 ? 1U : 0U;
  }
  return fit;
}

}  // namespace mapweld::merge
