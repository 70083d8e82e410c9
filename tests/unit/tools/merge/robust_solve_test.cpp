// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/robust_solve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "tests/bench/fleet_graph.hpp"

namespace mapweld::merge {
namespace {

using bench::FleetConfig;
using bench::FleetGraph;
using bench::MakeFleet;

FleetConfig SmallFleet(unsigned seed) {
  FleetConfig config;
  config.poses = 200;
  config.blocks = 3;
  config.true_loops = 120;
  config.seed = seed;
  return config;
}

struct Kept {
  int good = 0;
  int wrong = 0;
  int all_good = 0;
};

Kept Count(const FleetGraph& fleet, const RobustResult& result) {
  Kept out;
  for (std::size_t i = 0; i < fleet.is_true.size(); ++i) {
    out.all_good += fleet.is_true[i] ? 1 : 0;
    if (result.loop_weight[i] > 0.5) ++(fleet.is_true[i] ? out.good : out.wrong);
  }
  return out;
}

int Roots(const RobustResult& result) {
  std::vector<int> roots = result.root_of;
  std::sort(roots.begin(), roots.end());
  return static_cast<int>(std::unique(roots.begin(), roots.end()) - roots.begin());
}

// Percent of wrong loops, how many of them agree with each other, frames known or not.
class RobustSolve : public ::testing::TestWithParam<std::tuple<int, int, bool>> {};

TEST_P(RobustSolve, KeepsTheMapWhereItIsWhateverWrongLoopsAreAdded) {
  const auto [percent, group, known_frames] = GetParam();
  int towns = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    FleetConfig config = SmallFleet(seed);
    config.known_frames = known_frames;
    const FleetGraph clean = MakeFleet(config);
    const RobustResult undisturbed = SolveRobust(clean.graph, {});
    if (Roots(undisturbed) != 1) continue;  // two vehicles share too few places: nothing that wrong loops could spoil
    ++towns;
    const double clean_m = bench::AbsoluteError(undisturbed.world_T_node, clean.truth);
    config.wrong_share = percent / 100.0;
    config.wrong_group = group;
    const FleetGraph dirty = MakeFleet(config);
    const RobustResult result = SolveRobust(dirty.graph, {});
    EXPECT_EQ(Roots(result), 1);
    EXPECT_LT(bench::AbsoluteError(result.world_T_node, dirty.truth), 1.2 * clean_m) << "seed " << seed;
    const Kept kept = Count(dirty, result);
    EXPECT_EQ(kept.wrong, 0) << "seed " << seed;
    EXPECT_GE(kept.good, 0.9 * kept.all_good) << "seed " << seed;
  }
  EXPECT_GE(towns, 3);
}

INSTANTIATE_TEST_SUITE_P(Wrong, RobustSolve,
                         ::testing::Values(std::tuple(10, 1, true), std::tuple(50, 1, true), std::tuple(10, 1, false),
                                           std::tuple(30, 1, false), std::tuple(50, 1, false),
                                           std::tuple(30, 5, false)));

// Vehicles that never meet, and loops that say they do.
int TimesTied(int trials, int wrong_loops, int group) {
  int tied = 0;
  for (int trial = 0; trial < trials; ++trial) {
    FleetConfig config;
    config.vehicles = 2;
    config.poses = 40;
    config.blocks = 4;
    config.shared_streets = false;
    config.true_loops = wrong_loops;
    config.wrong_share = 0.5;
    config.wrong_group = group;
    config.seed = static_cast<unsigned>(1000 + trial);
    tied += Roots(SolveRobust(MakeFleet(config).graph, {})) == 1 ? 1 : 0;
  }
  return tied;
}

TEST(RobustSolveWithoutOverlap, NeverTiesVehiclesThatDoNotMeet) {
  EXPECT_EQ(TimesTied(1000, 20, 1), 0);
}

TEST(RobustSolveWithoutOverlap, IsNotMovedByOneLoop) {
  EXPECT_EQ(TimesTied(1000, 1, 1), 0);
}

TEST(RobustSolveWithoutOverlap, IsNotMovedByFiveLoopsOfALookAlikeStreet) {
  EXPECT_EQ(TimesTied(200, 5, 5), 0);
}

TEST(RobustSolve, GivesTheSameBitsInAnyOrderOfLoops) {
  FleetConfig config = SmallFleet(5);
  config.wrong_share = 0.3;
  const FleetGraph fleet = MakeFleet(config);
  const RobustResult first = SolveRobust(fleet.graph, {});
  std::mt19937 random(2);
  for (int trial = 0; trial < 3; ++trial) {
    ChainGraph graph = fleet.graph;
    std::vector<std::size_t> from(graph.loops.size());
    for (std::size_t i = 0; i < from.size(); ++i) from[i] = i;
    for (std::size_t i = from.size() - 1; i > 0; --i) std::swap(from[i], from[random() % (i + 1)]);
    for (std::size_t i = 0; i < from.size(); ++i) graph.loops[i] = fleet.graph.loops[from[i]];
    const RobustResult other = SolveRobust(graph, {});
    for (std::size_t i = 0; i < from.size(); ++i) ASSERT_EQ(other.loop_weight[i], first.loop_weight[from[i]]);
    for (std::size_t i = 0; i < first.world_T_node.size(); ++i) {
      ASSERT_EQ(other.world_T_node[i].t, first.world_T_node[i].t);
      ASSERT_EQ(other.world_T_node[i].q.coeffs(), first.world_T_node[i].q.coeffs());
    }
  }
}

TEST(RobustSolve, GoesOnAsIfBadLoopsWereNotThere) {
  const FleetGraph fleet = MakeFleet(SmallFleet(3));
  const RobustResult clean = SolveRobust(fleet.graph, {});
  ChainGraph graph = fleet.graph;
  pose_graph::Edge bad = graph.loops.front();
  bad.a_T_b.t.y() = std::numeric_limits<double>::quiet_NaN();
  graph.loops.push_back(bad);
  bad = graph.loops.front();
  bad.information *= 1e30;
  graph.loops.push_back(bad);
  bad = graph.loops.front();
  bad.b = 100000;
  graph.loops.push_back(bad);
  const RobustResult result = SolveRobust(graph, {});
  for (std::size_t i = 0; i < clean.world_T_node.size(); ++i) {
    ASSERT_EQ(result.world_T_node[i].t, clean.world_T_node[i].t);
  }
  for (std::size_t i = fleet.graph.loops.size(); i < graph.loops.size(); ++i) EXPECT_EQ(result.loop_weight[i], 0);
}

TEST(RobustSolve, RefusesOdometryThatIsNotFinite) {
  FleetGraph fleet = MakeFleet(SmallFleet(3));
  fleet.graph.odometry[4].a_T_b.t.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)SolveRobust(fleet.graph, {}), std::runtime_error);
}

// Loops between the first and the third vehicle, from one end to the other of a street that looks like another one.
TEST(RobustSolve, TakesAPairAwayThatContradictsTheWayRound) {
  FleetConfig config = SmallFleet(8);
  config.blocks = 2;
  config.true_loops = 200;
  FleetGraph fleet = MakeFleet(config);
  ChainGraph& graph = fleet.graph;
  std::erase_if(graph.loops,
                [&](const pose_graph::Edge& loop) { return graph.ChainOf(loop.a) == 0 && graph.ChainOf(loop.b) == 2; });
  const std::size_t good = graph.loops.size();
  ASSERT_GT(good, 20U);
  const geom::Pose3 moved =
      fleet.truth[10] * geom::Pose3{{0, 3, 0}, geom::Quatd::Identity()} * fleet.truth[500].Inverse();
  for (int m = 0; m < 8; ++m) {
    pose_graph::Edge wrong = graph.loops.front();
    wrong.a = 10 + 3 * m;
    wrong.b = 500 + 3 * m;
    wrong.a_T_b = fleet.truth[static_cast<std::size_t>(wrong.a)].Inverse() * moved *
                  fleet.truth[static_cast<std::size_t>(wrong.b)];
    graph.loops.push_back(wrong);
  }
  const RobustResult result = SolveRobust(graph, {});
  EXPECT_EQ(Roots(result), 1) << "the others still tie all three";
  for (std::size_t i = 0; i < graph.loops.size(); ++i) {
    if (i < good) {
      EXPECT_GT(result.loop_weight[i], 0.3) << i;
    } else {
      EXPECT_LT(result.loop_weight[i], 0.1) << i;
    }
  }
}

}  // namespace
}  // namespace mapweld::merge
