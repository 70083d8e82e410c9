// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/growth_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/eval/growth_study.hpp"
#include "tools/eval/place_sessions.hpp"
#include "tools/report/line_chart.hpp"

namespace mapweld::eval {
namespace {

struct Arguments {
  SessionArguments sessions;
  std::vector<double> lengths_m = {300, 600, 1200, 2400};
  std::filesystem::path plot;
  bool json = false;
};

std::string Table(const std::vector<GrowthStep>& steps) {
  std::string out = " longest     all  keyframes  groups  zones  mixed  overlaps  found  wrong  rmse (m)  seconds\n";
  for (const GrowthStep& s : steps) {
    out += fmt::format("{:>6} m {:>4.1f} km {:>10} {:>7} {:>6} {:>6} {:>9} {:>6} {:>6} {:>9.3f} {:>8.1f}\n",
                       s.longest_m, s.path_km, s.keyframes, s.groups, s.zones, s.mixed_groups, s.overlaps, s.found,
                       s.wrong, s.rmse_m, s.seconds);
  }
  return out +
         "Every drive cut off at `longest`, merged from nothing. zones: what groups should be; mixed: groups of two "
         "zones.\noverlaps: pairs that share 30 m of path; wrong: accepted pairs that never meet. seconds: wall "
         "clock.\n";
}

std::string StepsJson(const std::vector<GrowthStep>& steps) {
  using Json = nlohmann::ordered_json;
  Json all = Json::array();
  for (const GrowthStep& s : steps) {
    Json stages = Json::object();
    for (const merge::StageTime& stage : s.stages) stages[stage.stage] = stage.seconds;
    all.push_back({{"longest_m", s.longest_m},
                   {"path_km", s.path_km},
                   {"keyframes", s.keyframes},
                   {"groups", s.groups},
                   {"zones", s.zones},
                   {"mixed_groups", s.mixed_groups},
                   {"accepted", s.accepted},
                   {"wrong", s.wrong},
                   {"overlaps", s.overlaps},
                   {"found", s.found},
                   {"rmse_m", s.rmse_m},
                   {"seconds", s.seconds},
                   {"stages", std::move(stages)}});
  }
  return Json{{"steps", std::move(all)}}.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

// Groups and zones over the length.
std::vector<report::LineChart> Charts(const std::vector<GrowthStep>& steps) {
  const auto round_up = [](double value) { return std::max(5.0, 5 * std::ceil(value / 5)); };
  double most = 1;
  for (const GrowthStep& s : steps) most = std::max<double>(most, std::max(s.groups, s.zones));
  const double longest = steps.back().longest_m;
  report::LineChart groups{
      "groups", {"every drive cut off at (m)", 0, longest, longest / 4}, {"", 0, round_up(most), 5}, {}, true};
  groups.series = {{"merge", {}}, {"truth", {}}};
  for (const GrowthStep& s : steps) {
    groups.series[0].points.push_back({s.longest_m, static_cast<double>(s.groups)});
    groups.series[1].points.push_back({s.longest_m, static_cast<double>(s.zones)});
  }
  return {groups};
}

void Run(Arguments arguments) {
  std::sort(arguments.lengths_m.begin(), arguments.lengths_m.end());
  merge::TerminalProgress progress("eval");
  std::vector<describe::KeyframeSource> sources;
  ForEachSession(arguments.sessions, &progress,
                 [&](describe::KeyframeSource source) { sources.push_back(std::move(source)); });
  std::sort(sources.begin(), sources.end(), [](const auto& a, const auto& b) { return a.drive.name < b.drive.name; });
  const std::vector<GrowthStep> steps =
      StudyGrowth(sources, arguments.lengths_m, arguments.sessions.threads, &progress);
  progress.Finish();
  fmt::print("{}", arguments.json ? StepsJson(steps) : Table(steps));
  if (arguments.plot.empty()) return;
  const std::string note = report::WriteCharts(arguments.plot, Charts(steps));
  if (!note.empty()) fmt::print(stderr, "note: {}\n", note);
}

}  // namespace

void AddGrowthCommand(CLI::App& eval) {
  CLI::App* const command = eval.add_subcommand("growth", "what a merge finds and costs while its drives grow");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("inputs", arguments->sessions.inputs, "recordings or .lcm logs of agents, drives of one world")
      ->required();
  command->add_option("--lengths", arguments->lengths_m, "cut every drive off at these lengths, m")
      ->delimiter(',')
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--truth-folder", arguments->sessions.truth_folder,
                      "NAME.tum for each recording or log: true positions instead of its own");
  command->add_option("--threads", arguments->sessions.threads, "0: all of the machine; never changes the result")
      ->check(CLI::Range(0, 1024));
  command->add_option("--plot", arguments->plot, "write the curves as FILE.svg and FILE.png");
  command->add_flag("--json", arguments->json, "print JSON instead of a table");
  command->callback([arguments] { Run(*arguments); });
}

}  // namespace mapweld::eval
