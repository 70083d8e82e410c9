// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/arrival_study.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "tools/eval/json_file.hpp"
#include "tools/merge/clustering.hpp"
#include "tools/merge/merge_config.hpp"

namespace mapweld::eval {
namespace {

using Groups = std::vector<std::vector<int>>;

// The groups of the drives that are there, by their own indices.
Groups GroupsOf(const std::vector<int>& there, const Eigen::MatrixXd& weights, const merge::WeightConfig& config) {
  Groups groups = merge::ClusterDrives(weights(there, there), config);
  for (std::vector<int>& group : groups) {
    for (int& drive : group) drive = there[static_cast<std::size_t>(drive)];
    std::sort(group.begin(), group.end());
  }
  return groups;
}

int CountMixed(const Groups& groups, const std::vector<int>& zones) {
  if (zones.empty()) return 0;
  return static_cast<int>(std::count_if(groups.begin(), groups.end(), [&](const std::vector<int>& group) {
    return std::any_of(group.begin(), group.end(), [&](int drive) {
      return zones[static_cast<std::size_t>(drive)] != zones[static_cast<std::size_t>(group.front())];
    });
  }));
}

}  // namespace

MergedDrives ReadMergedDrives(const std::filesystem::path& folder) {
  MergedDrives drives;
  WithJson(folder / "groups.json", [&](const nlohmann::ordered_json& json) {
    for (const auto& group : json.at("groups")) {
      for (const auto& name : group.at("recordings")) drives.names.push_back(name.get<std::string>());
    }
  });
  std::sort(drives.names.begin(), drives.names.end());
  const auto index = [&](const std::string& name) {
    const auto at = std::lower_bound(drives.names.begin(), drives.names.end(), name);
    if (at == drives.names.end() || *at != name) {
      throw std::runtime_error(fmt::format("{}: '{}' is in no group", (folder / "overlaps.json").string(), name));
    }
    return static_cast<int>(at - drives.names.begin());
  };
  WithJson(folder / "overlaps.json", [&](const nlohmann::ordered_json& json) {
    for (const auto& overlap : json.at("overlaps")) {
      if (overlap.at("verdict") != "accepted") continue;
      drives.overlaps.push_back({index(overlap.at("pair").at(0)), index(overlap.at("pair").at(1)),
                                 overlap.at("length_m").get<double>(), overlap.at("weight").get<double>()});
    }
  });
  return drives;
}

double Reweighed(const WeighedOverlap& overlap, double from_m, double to_m) {
  const double difference = 2 * std::numbers::ln2 * (from_m * from_m - to_m * to_m);
  return overlap.weight * std::exp(difference / (2 * overlap.length_m * overlap.length_m + 1e-4));
}

ArrivalStudy StudyArrivals(const MergedDrives& drives, const std::vector<int>& zones, double half_weight_m, int orders,
                           std::uint32_t seed) {
  const merge::WeightConfig config;
  const auto count = static_cast<Eigen::Index>(drives.names.size());
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(count, count);
  for (const WeighedOverlap& overlap : drives.overlaps) {
    const double weight = Reweighed(overlap, config.half_weight_overlap_m, half_weight_m);
    weights(overlap.first, overlap.second) = weights(overlap.second, overlap.first) = weight;
  }
  ArrivalStudy study;
  study.half_weight_m = half_weight_m;
  study.steps.resize(drives.names.size());
  std::set<Groups> outcomes;
  std::mt19937 random(seed);
  for (int order = 0; order < orders; ++order) {
    std::vector<int> arrivals(drives.names.size());
    for (std::size_t i = 0; i < arrivals.size(); ++i) {  // a random order, the same with every library
      const std::size_t j = random() % (i + 1);
      arrivals[i] = arrivals[j];
      arrivals[j] = static_cast<int>(i);
    }
    std::vector<int> there;
    for (std::size_t i = 0; i < arrivals.size(); ++i) {
      there.insert(std::upper_bound(there.begin(), there.end(), arrivals[i]), arrivals[i]);
      const Groups groups = GroupsOf(there, weights, config);
      const int number = static_cast<int>(groups.size());
      ArrivalStep& step = study.steps[i];
      step.mean_groups += static_cast<double>(number) / orders;
      step.fewest_groups = order == 0 ? number : std::min(step.fewest_groups, number);
      step.most_groups = std::max(step.most_groups, number);
      step.mixed_groups += CountMixed(groups, zones);
      if (i + 1 == arrivals.size()) outcomes.insert(groups);
    }
  }
  study.outcomes = static_cast<int>(outcomes.size());
  return study;
}

}  // namespace mapweld::eval
