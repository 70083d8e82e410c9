// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/arrivals_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/eval/arrival_study.hpp"
#include "tools/eval/merge_score.hpp"
#include "tools/report/line_chart.hpp"

namespace mapweld::eval {
namespace {

constexpr std::size_t kTableRows = 10;

struct Arguments {
  std::filesystem::path result;
  std::filesystem::path truth;
  std::vector<double> half_weights_m = {5, 10, 20, 40};
  int orders = 100;
  std::uint32_t seed = 1;
  std::filesystem::path plot;
  bool json = false;
};

std::vector<int> ZonesByNumber(const std::filesystem::path& truth, const MergedDrives& drives) {
  if (truth.empty()) return {};
  const std::map<std::string, std::string> zones = ZonesOf(ReadMergeTruth(truth));
  std::map<std::string, int> number;
  std::vector<int> out;
  for (const std::string& name : drives.names) {
    const auto zone = zones.find(name);
    if (zone == zones.end()) throw std::runtime_error(fmt::format("{} has no drive '{}'", truth.string(), name));
    out.push_back(number.try_emplace(zone->second, static_cast<int>(number.size())).first->second);
  }
  return out;
}

std::string Table(const std::vector<ArrivalStudy>& studies, bool has_truth, int orders) {
  std::string out = "drives there";
  for (const ArrivalStudy& study : studies) out += fmt::format("  {:>15}", fmt::format("{} m", study.half_weight_m));
  out += '\n';
  const std::size_t drives = studies.front().steps.size();
  const std::size_t stride = (drives + kTableRows - 1) / kTableRows;
  for (std::size_t i = 0; i < drives; ++i) {
    if (i + 1 != drives && (i + 1) % stride != 0) continue;
    out += fmt::format("{:>12}", i + 1);
    for (const ArrivalStudy& study : studies) {
      const ArrivalStep& step = study.steps[i];
      out += fmt::format("  {:>15}",
                         fmt::format("{:.1f} ({}-{})", step.mean_groups, step.fewest_groups, step.most_groups));
    }
    out += '\n';
  }
  out += fmt::format(
      "Groups (mean, fewest-most) over {} random orders, by the shared length that makes the weight 1/2.\n", orders);
  for (const ArrivalStudy& study : studies) {
    int mixed = 0;
    for (const ArrivalStep& step : study.steps) mixed += step.mixed_groups;
    out += fmt::format(
        "{} m: {} at the end", study.half_weight_m,
        study.outcomes == 1 ? "the same groups in every order" : fmt::format("{} different groupings", study.outcomes));
    if (has_truth) out += fmt::format("; mixed groups in all steps of all orders: {}", mixed);
    out += '\n';
  }
  return out;
}

std::string StudyJson(const std::vector<ArrivalStudy>& studies, int orders) {
  using Json = nlohmann::ordered_json;
  Json all = Json::array();
  for (const ArrivalStudy& study : studies) {
    Json steps = Json::array();
    for (const ArrivalStep& step : study.steps) {
      steps.push_back({{"mean_groups", step.mean_groups},
                       {"fewest_groups", step.fewest_groups},
                       {"most_groups", step.most_groups},
                       {"mixed_groups", step.mixed_groups}});
    }
    all.push_back({{"half_weight_m", study.half_weight_m}, {"outcomes", study.outcomes}, {"steps", std::move(steps)}});
  }
  return Json{{"orders", orders}, {"studies", std::move(all)}}.dump(2, ' ', false, Json::error_handler_t::replace) +
         '\n';
}

report::LineChart Chart(const std::vector<ArrivalStudy>& studies) {
  const auto drives = static_cast<double>(studies.front().steps.size());
  double most = 1;
  report::LineChart chart{"groups while drives arrive", {"drives there", 0, drives, 1}, {"groups", 0, 1, 1}, {}, true};
  for (const ArrivalStudy& study : studies) {
    chart.series.push_back({fmt::format("half weight at {} m", study.half_weight_m), {{0, 0}}});
    for (std::size_t i = 0; i < study.steps.size(); ++i) {
      chart.series.back().points.push_back({static_cast<double>(i + 1), study.steps[i].mean_groups});
      most = std::max(most, study.steps[i].mean_groups);
    }
  }
  chart.y.to = std::ceil(most) + 1;
  chart.y.tick = std::ceil(chart.y.to / 8);
  chart.x.tick = std::ceil(drives / 10);
  return chart;
}

void Run(const Arguments& arguments) {
  const MergedDrives drives = ReadMergedDrives(arguments.result);
  if (drives.names.empty()) throw std::runtime_error(fmt::format("{} holds no drives", arguments.result.string()));
  const std::vector<int> zones = ZonesByNumber(arguments.truth, drives);
  std::vector<ArrivalStudy> studies;
  for (const double half_weight_m : arguments.half_weights_m) {
    studies.push_back(StudyArrivals(drives, zones, half_weight_m, arguments.orders, arguments.seed));
  }
  fmt::print("{}",
             arguments.json ? StudyJson(studies, arguments.orders) : Table(studies, !zones.empty(), arguments.orders));
  if (arguments.plot.empty()) return;
  const std::string note = report::WriteCharts(arguments.plot, {Chart(studies)});
  if (!note.empty()) fmt::print(stderr, "note: {}\n", note);
}

}  // namespace

void AddArrivalsCommand(CLI::App& eval) {
  CLI::App* const command = eval.add_subcommand("arrivals", "how groups grow while drives arrive in random order");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("result", arguments->result, "output folder of mapweld merge or serve")->required();
  command->add_option("--truth", arguments->truth, "scenario.json of mapweld sim, to tell mixed groups");
  command->add_option("--half-weight", arguments->half_weights_m, "shared lengths that make the weight 1/2, m")
      ->delimiter(',')
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--orders", arguments->orders, "random orders")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", arguments->seed, "of the orders")->capture_default_str();
  command->add_option("--plot", arguments->plot, "write the curves as FILE.svg and FILE.png");
  command->add_flag("--json", arguments->json, "print JSON instead of a table");
  command->callback([arguments] { Run(*arguments); });
}

}  // namespace mapweld::eval
