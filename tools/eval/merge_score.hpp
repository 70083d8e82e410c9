// SPDX-License-Identifier: Apache-2.0
// How right a merge was: which pairs of drives it joined, against those that truly share a street.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace mapweld::eval {

using NamePair = std::pair<std::string, std::string>;  // first < second

// As `mapweld sim` writes it into scenario.json.
struct MergeTruth {
  std::set<std::string> names;
  std::map<NamePair, double> overlaps;  // driven together, m; at least 30
  std::set<NamePair> crossings;         // the drives come within 10 m of each other, for less than that
};

// As `mapweld merge` and `mapweld serve` write it: overlaps.json and groups.json.
struct MergeOutcome {
  std::set<NamePair> accepted;
  std::map<NamePair, std::string> refused;  // and the test that refused it
  std::vector<std::vector<std::string>> groups;
};

// Both throw std::runtime_error naming the file and what is wrong with it.
MergeTruth ReadMergeTruth(const std::filesystem::path& scenario_json);
MergeOutcome ReadMergeOutcome(const std::filesystem::path& folder);

// The zone of every drive: the smallest name that is connected with it by overlaps and crossings.
std::map<std::string, std::string> ZonesOf(const MergeTruth& truth);

struct MissedOverlap {
  NamePair pair;
  double shared_m = 0;
  std::string test;  // that refused it; empty: never proposed
};

// precision = accepted pairs that meet in truth / accepted pairs (1 when none was accepted); recall = true overlaps
// that were accepted / true overlaps. Accepted crossings are right, but not asked for by recall. A group is pure when
// all its drives belong to one zone: drives that are connected by true overlaps or crossings. Only drives that were
// merged count: those of a scenario that are in no group are told, and otherwise as if they had never been driven.
struct MergeScore {
  int not_merged = 0;  // drives of the scenario that are in no group
  int accepted = 0;
  int true_overlaps = 0;
  int found = 0;
  int crossings_found = 0;
  int groups = 0;
  int impure_groups = 0;
  int zones = 0;
  std::vector<NamePair> wrong;
  std::vector<MissedOverlap> missed;  // most shared street first
  [[nodiscard]] double Precision() const;
  [[nodiscard]] double Recall() const;
};
MergeScore ScoreMerge(const MergeTruth& truth, const MergeOutcome& outcome);

std::string ScoreTable(const MergeScore& score);
std::string ScoreJson(const MergeScore& score);

}  // namespace mapweld::eval
