// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/grouping.hpp"

#include <algorithm>

#include "tools/merge/clustering.hpp"
#include "tools/merge/group_solver.hpp"
#include "tools/merge/pair_search.hpp"

namespace mapweld::merge {
namespace {

bool InOneGroup(const MergeResult& result, const Overlap& overlap) {
  return result.group_of[static_cast<std::size_t>(overlap.drive_a)] ==
         result.group_of[static_cast<std::size_t>(overlap.drive_b)];
}

// By the merge itself, after registration; a refusal by hand has no loops.
bool WithdrawnLater(const Overlap& overlap) {
  return !overlap.accepted && !overlap.loops.empty() && (overlap.test == "cycle" || overlap.test == "pose graph");
}

void Withdraw(const char* test, Overlap* overlap) {
  overlap->accepted = false;
  overlap->test = test;
  overlap->weight = 0;
}

void FormGroups(std::size_t drives, const WeightConfig& config, MergeResult* result) {
  const auto n = static_cast<Eigen::Index>(drives);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(n, n);
  for (const Overlap& overlap : result->overlaps) {
    if (overlap.accepted)
      weights(overlap.drive_a, overlap.drive_b) = weights(overlap.drive_b, overlap.drive_a) = overlap.weight;
  }
  result->groups = ClusterDrives(weights, config);
  result->group_of.assign(drives, 0);
  for (std::size_t g = 0; g < result->groups.size(); ++g) {
    for (const int drive : result->groups[g]) result->group_of[static_cast<std::size_t>(drive)] = static_cast<int>(g);
  }
}

GroupSolution SolveOne(const std::vector<Drive>& drives, const std::vector<int>& group, const GraphConfig& config,
                       const MergeResult& result) {
  if (group.size() > 1) return SolveGroup(drives, group, result.overlaps, config);
  GroupSolution alone;
  alone.merged_T_body.emplace_back();
  for (const Keyframe& keyframe : drives[static_cast<std::size_t>(group.front())].keyframes) {
    alone.merged_T_body.front().push_back(keyframe.odom_T_body);
  }
  return alone;
}

void SolveAll(const std::vector<Drive>& drives, const GraphConfig& config, Crew* crew, MergeResult* result) {
  std::vector<GroupSolution> solutions =
      crew->Do("groups", static_cast<int>(result->groups.size()), [&](int g) -> GroupSolution {
        return SolveOne(drives, result->groups[static_cast<std::size_t>(g)], config, *result);
      });
  result->merged_T_body.assign(drives.size(), {});
  for (std::size_t g = 0; g < solutions.size(); ++g) {
    const std::vector<int>& group = result->groups[g];
    SetLoopWeights(group, solutions[g], &result->overlaps);
    for (std::size_t i = 0; i < group.size(); ++i) {
      result->merged_T_body[static_cast<std::size_t>(group[i])] = std::move(solutions[g].merged_T_body[i]);
    }
  }
}

bool WithdrawDisbelieved(const GraphConfig& config, MergeResult* result) {
  bool any = false;
  for (Overlap& overlap : result->overlaps) {
    if (!overlap.accepted || !InOneGroup(*result, overlap)) continue;
    double sum = 0;
    for (const Loop& loop : overlap.loops) sum += loop.weight;
    if (sum >= config.min_mean_weight * static_cast<double>(overlap.loops.size())) continue;
    Withdraw("pose graph", &overlap);
    any = true;
  }
  return any;
}

// The drive with most withdrawn overlaps, if it has too many. One at a time: it may have spoiled those of others.
bool QuarantineWorst(std::size_t drives, const GraphConfig& config, MergeResult* result) {
  std::vector<int> withdrawn(drives, 0);
  std::vector<int> left(drives, 0);
  for (const Overlap& overlap : result->overlaps) {
    for (const int drive : {overlap.drive_a, overlap.drive_b}) {
      withdrawn[static_cast<std::size_t>(drive)] += WithdrawnLater(overlap) ? 1 : 0;
      left[static_cast<std::size_t>(drive)] += overlap.accepted ? 1 : 0;
    }
  }
  const auto worst = std::max_element(withdrawn.begin(), withdrawn.end());
  if (worst == withdrawn.end() || *worst <= config.quarantine_after) return false;
  const auto drive = static_cast<int>(worst - withdrawn.begin());
  if (*worst <= left[static_cast<std::size_t>(drive)]) return false;
  for (Overlap& overlap : result->overlaps) {
    if (overlap.drive_a != drive && overlap.drive_b != drive) continue;
    if (overlap.accepted || WithdrawnLater(overlap)) Withdraw("quarantine", &overlap);
  }
  return true;
}

}  // namespace

void GroupAndSolve(const std::vector<Drive>& drives, const MergeConfig& config, Crew* crew, MergeResult* result) {
  do {
    while (QuarantineWorst(drives.size(), config.graph, result)) {
    }
    FormGroups(drives.size(), config.weight, result);
    SolveAll(drives, config.graph, crew, result);
  } while (WithdrawDisbelieved(config.graph, result));
}

bool RecallOverlaps(const std::vector<Drive>& drives, const MergeConfig& config, MergeResult* result) {
  bool any = false;
  for (Overlap& overlap : result->overlaps) {
    if (!WithdrawnLater(overlap) || overlap.loops.empty() || !InOneGroup(*result, overlap)) continue;
    const std::size_t fit = LoopsThatFit(drives, overlap, result->merged_T_body, config.graph);
    if (2 * fit <= overlap.loops.size()) continue;
    overlap.accepted = true;
    overlap.test = "recalled";
    Summarise(drives, config, &overlap);
    any = true;
  }
  return any;
}

}  // namespace mapweld::merge
