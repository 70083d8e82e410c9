// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/merge_score.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tools/eval/json_file.hpp"

namespace mapweld::eval {
namespace {

using Json = nlohmann::ordered_json;

NamePair Ordered(std::string a, std::string b) {
  return a < b ? NamePair{std::move(a), std::move(b)} : NamePair{std::move(b), std::move(a)};
}

// The truth of the drives that are in some group.
MergeTruth TruthOfMerged(const MergeTruth& truth, const MergeOutcome& outcome) {
  MergeTruth out;
  for (const std::vector<std::string>& group : outcome.groups) {
    for (const std::string& name : group) {
      if (!truth.names.contains(name)) throw std::runtime_error(fmt::format("the truth has no drive '{}'", name));
      out.names.insert(name);
    }
  }
  const auto merged = [&](const NamePair& pair) {
    return out.names.contains(pair.first) && out.names.contains(pair.second);
  };
  for (const auto& [pair, shared_m] : truth.overlaps) {
    if (merged(pair)) out.overlaps.emplace(pair, shared_m);
  }
  for (const NamePair& pair : truth.crossings) {
    if (merged(pair)) out.crossings.insert(pair);
  }
  return out;
}

// At most this many lines of one kind; a table that nobody reads to its end says nothing.
constexpr std::size_t kMostLines = 20;

std::string AndMore(std::size_t lines) {
  return lines > kMostLines ? fmt::format("... and {} more; --json has all\n", lines - kMostLines) : "";
}

}  // namespace

std::map<std::string, std::string> ZonesOf(const MergeTruth& truth) {
  std::map<std::string, std::string> parent;
  for (const std::string& name : truth.names) parent[name] = name;
  const auto root = [&](std::string name) {
    while (parent.at(name) != name) name = parent.at(name);
    return name;
  };
  const auto join = [&](const NamePair& pair) {
    const NamePair roots = Ordered(root(pair.first), root(pair.second));
    parent[roots.second] = roots.first;
  };
  for (const auto& [pair, shared_m] : truth.overlaps) join(pair);
  for (const NamePair& pair : truth.crossings) join(pair);
  std::map<std::string, std::string> zones;
  for (const std::string& name : truth.names) zones[name] = root(name);
  return zones;
}

MergeTruth ReadMergeTruth(const std::filesystem::path& scenario_json) {
  MergeTruth truth;
  WithJson(scenario_json, [&](const Json& json) {
    const auto name = [](const Json& id) { return fmt::format("agent_{}", id.get<int>()); };
    for (const Json& vehicle : json.at("vehicles")) truth.names.insert(name(vehicle.at("id")));
    for (const Json& meeting : json.at("overlaps_of_whole_routes")) {
      const NamePair pair = Ordered(name(meeting.at("vehicles").at(0)), name(meeting.at("vehicles").at(1)));
      if (!truth.names.contains(pair.first) || !truth.names.contains(pair.second)) continue;  // not simulated
      if (meeting.at("kind") == "crossing") {
        truth.crossings.insert(pair);
      } else {
        truth.overlaps[pair] =
            meeting.at("same_direction_m").get<double>() + meeting.at("opposite_direction_m").get<double>();
      }
    }
  });
  return truth;
}

MergeOutcome ReadMergeOutcome(const std::filesystem::path& folder) {
  MergeOutcome outcome;
  WithJson(folder / "overlaps.json", [&](const Json& json) {
    for (const Json& overlap : json.at("overlaps")) {
      NamePair pair = Ordered(overlap.at("pair").at(0), overlap.at("pair").at(1));
      if (overlap.at("verdict") == "accepted") {
        outcome.accepted.insert(std::move(pair));
      } else {
        outcome.refused[std::move(pair)] = overlap.at("test");
      }
    }
  });
  WithJson(folder / "groups.json", [&](const Json& json) {
    for (const Json& group : json.at("groups")) outcome.groups.push_back(group.at("recordings"));
  });
  return outcome;
}

double MergeScore::Precision() const {
  return accepted > 0 ? 1 - static_cast<double>(wrong.size()) / accepted : 1;
}

double MergeScore::Recall() const {
  return true_overlaps > 0 ? static_cast<double>(found) / true_overlaps : 1;
}

MergeScore ScoreMerge(const MergeTruth& whole_truth, const MergeOutcome& outcome) {
  const MergeTruth truth = TruthOfMerged(whole_truth, outcome);
  MergeScore score;
  score.not_merged = static_cast<int>(whole_truth.names.size() - truth.names.size());
  score.accepted = static_cast<int>(outcome.accepted.size());
  score.true_overlaps = static_cast<int>(truth.overlaps.size());
  for (const NamePair& pair : outcome.accepted) {
    if (truth.overlaps.contains(pair)) {
      ++score.found;
    } else if (truth.crossings.contains(pair)) {
      ++score.crossings_found;
    } else {
      score.wrong.push_back(pair);
    }
  }
  for (const auto& [pair, shared_m] : truth.overlaps) {
    if (outcome.accepted.contains(pair)) continue;
    const auto refused = outcome.refused.find(pair);
    score.missed.push_back({pair, shared_m, refused == outcome.refused.end() ? "" : refused->second});
  }
  std::stable_sort(score.missed.begin(), score.missed.end(),
                   [](const MissedOverlap& a, const MissedOverlap& b) { return a.shared_m > b.shared_m; });
  const std::map<std::string, std::string> zones = ZonesOf(truth);
  std::set<std::string> roots;
  for (const auto& [name, root] : zones) roots.insert(root);
  score.zones = static_cast<int>(roots.size());
  score.groups = static_cast<int>(outcome.groups.size());
  for (const std::vector<std::string>& group : outcome.groups) {
    std::set<std::string> of_group;
    for (const std::string& name : group) of_group.insert(zones.at(name));
    score.impure_groups += of_group.size() > 1 ? 1 : 0;
  }
  return score;
}

std::string ScoreTable(const MergeScore& score) {
  std::string out = fmt::format(
      "overlaps: {} true, {} found, {} wrong of {} accepted ({} crossings among them); precision {:.3f}, recall "
      "{:.3f}\n"
      "groups: {} of {} zones, {} of them mixed\n",
      score.true_overlaps, score.found, score.wrong.size(), score.accepted, score.crossings_found, score.Precision(),
      score.Recall(), score.groups, score.zones, score.impure_groups);
  if (score.not_merged > 0) {
    out += fmt::format("{} drives of the scenario are in no group and do not count\n", score.not_merged);
  }
  for (std::size_t i = 0; i < std::min(kMostLines, score.wrong.size()); ++i) {
    out += fmt::format("wrong: {} {}\n", score.wrong[i].first, score.wrong[i].second);
  }
  out += AndMore(score.wrong.size());
  for (std::size_t i = 0; i < std::min(kMostLines, score.missed.size()); ++i) {
    const MissedOverlap& m = score.missed[i];
    out += fmt::format("missed: {} {}, {:.0f} m together: {}\n", m.pair.first, m.pair.second, m.shared_m,
                       m.test.empty() ? "never proposed" : m.test);
  }
  return out + AndMore(score.missed.size());
}

std::string ScoreJson(const MergeScore& score) {
  Json wrong = Json::array();
  for (const auto& [a, b] : score.wrong) wrong.push_back({a, b});
  Json missed = Json::array();
  for (const MissedOverlap& m : score.missed) {
    missed.push_back({{"pair", {m.pair.first, m.pair.second}}, {"shared_m", m.shared_m}, {"test", m.test}});
  }
  const Json json = {{"precision", score.Precision()},
                     {"recall", score.Recall()},
                     {"accepted", score.accepted},
                     {"true_overlaps", score.true_overlaps},
                     {"found", score.found},
                     {"crossings_found", score.crossings_found},
                     {"groups", score.groups},
                     {"zones", score.zones},
                     {"not_merged", score.not_merged},
                     {"impure_groups", score.impure_groups},
                     {"wrong", wrong},
                     {"missed", missed}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace mapweld::eval
