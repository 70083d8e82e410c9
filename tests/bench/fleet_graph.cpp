// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/fleet_graph.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/bench/street_walk.hpp"
#include "tools/eval/trajectory_error.hpp"

namespace mapweld::bench {
namespace {

using geom::Pose3;
using geom::Vec3d;
using pose_graph::Edge;

constexpr double kOdometry_m = 0.05;
constexpr double kOdometry_rad = 0.003;
constexpr double kLoop_m = 0.2;
constexpr double kLoop_rad = 0.01;
constexpr double kNear_m = 4;
constexpr double kFar_m = 30;
constexpr int kComesBack = 50;

class Fleet {
 public:
  explicit Fleet(const FleetConfig& config) : config_(config), dice_(config.seed) {}

  FleetGraph Make() {
    for (int vehicle = 0; vehicle < config_.vehicles; ++vehicle) AddVehicle(vehicle);
    if (config_.shared_streets) AddTrueLoops();
    AddWrongLoops();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const Pose3& Truth(int node) const { return out_.truth[static_cast<std::size_t>(node)]; }

  void AddVehicle(int vehicle) {
    std::vector<Pose3> way = WalkStreets(config_.poses, config_.blocks, &dice_);
    if (!config_.shared_streets) {
      for (Pose3& pose : way) pose.t.x() += 1e5 * vehicle;
    }
    merge::ChainGraph& graph = out_.graph;
    Pose3 frame;  // odometry frame in the world, but for the first vehicle
    if (vehicle > 0 && !config_.known_frames) {
      frame = {{dice_.Between(-500, 500), dice_.Between(-500, 500), dice_.Between(-5, 5)},
               geom::ExpSo3({0, 0, dice_.Between(-3, 3)})};
    }
    for (std::size_t k = 0; k < way.size(); ++k) {
      const int node = static_cast<int>(out_.truth.size());
      if (k == 0) {
        graph.chain_T_node.push_back(frame * way[0]);
      } else {
        const Pose3 step = way[k - 1].Inverse() * way[k] * dice_.Noise(kOdometry_m, kOdometry_rad);
        graph.odometry.push_back(
            {node - 1, node, step, pose_graph::InformationOf(Sigma(kOdometry_m, kOdometry_rad)), 1});
        graph.chain_T_node.push_back(graph.chain_T_node.back() * step);
      }
      graph.chain_of.push_back(vehicle);
      out_.truth.push_back(way[k]);
    }
  }

  void AddLoop(int a, int b, const Pose3& a_T_b, bool is_true) {
    const Pose3 measured = a_T_b * dice_.Noise(kLoop_m, kLoop_rad);
    out_.graph.loops.push_back({a, b, measured, pose_graph::InformationOf(Sigma(kLoop_m, kLoop_rad)), 1});
    out_.is_true.push_back(is_true);
  }

  void AddTrueLoops() {
    std::vector<std::pair<int, int>> near;
    const int n = static_cast<int>(out_.truth.size());
    for (int i = 0; i < n; ++i) {
      for (int k = i + kComesBack; k < n; ++k) {
        if ((Truth(i).t - Truth(k).t).norm() < kNear_m) near.emplace_back(i, k);
      }
    }
    for (int loop = 0; loop < config_.true_loops && !near.empty(); ++loop) {
      const std::size_t pick = static_cast<std::size_t>(dice_.Below(static_cast<int>(near.size())));
      const auto [i, k] = near[pick];
      near.erase(near.begin() + static_cast<std::ptrdiff_t>(pick));
      AddLoop(i, k, Truth(i).Inverse() * Truth(k), true);
    }
  }

  void AddWrongLoops() {
    const auto true_loops = static_cast<double>(config_.shared_streets ? out_.graph.loops.size()
                                                                       : static_cast<std::size_t>(config_.true_loops));
    int left = static_cast<int>(std::lround(config_.wrong_share * true_loops / (1 - config_.wrong_share)));
    const int n = static_cast<int>(out_.truth.size());
    while (left > 0) {
      // Both go on along a street of this length, where the vehicles in truth are far from each other.
      const int group = std::min(left, config_.wrong_group);
      const int length = 2 * (group - 1);
      const int i = dice_.Below(n - length);
      const int k = dice_.Below(n - length);
      const auto chain = [&](int node) { return out_.graph.ChainOf(node); };
      if (chain(i) != chain(i + length) || chain(k) != chain(k + length) || std::abs(i - k) < kComesBack) continue;
      if (config_.wrong_group > 1 && chain(i) == chain(k)) continue;
      if ((Truth(i).t - Truth(k).t).norm() < kFar_m) continue;
      // Where the second street seems to be.
      const Pose3 off(Vec3d(dice_.Between(-4, 4), dice_.Between(-4, 4), 0), geom::ExpSo3({0, 0, dice_.Between(-3, 3)}));
      const Pose3 moved = Truth(i) * off * Truth(k).Inverse();
      for (int m = 0; m < group; ++m)
        AddLoop(i + 2 * m, k + 2 * m, Truth(i + 2 * m).Inverse() * moved * Truth(k + 2 * m), false);
      left -= group;
    }
  }

  const FleetConfig& config_;
  Dice dice_;
  FleetGraph out_;
};

}  // namespace

FleetGraph MakeFleet(const FleetConfig& config) {
  return Fleet(config).Make();
}

double AbsoluteError(const std::vector<Pose3>& estimate, const std::vector<Pose3>& truth) {
  std::vector<Vec3d> a;
  std::vector<Vec3d> b;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    a.push_back(truth[i].t);
    b.push_back(estimate[i].t);
  }
  const Pose3 truth_T_estimate = eval::AlignRigidly(a, b);
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (truth_T_estimate * b[i] - a[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace mapweld::bench
