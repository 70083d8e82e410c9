// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/viewpoint_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/describe/variants.hpp"
#include "tools/eval/place_sessions.hpp"
#include "tools/eval/viewpoint_sweep.hpp"
#include "tools/report/line_chart.hpp"

namespace mapweld::eval {
namespace {

struct Arguments {
  SessionArguments sessions;
  SweepConfig sweep;
  std::filesystem::path plot;
  bool json = false;
};

std::string Table(const std::vector<SweepScore>& scores) {
  std::size_t width = std::string_view("descriptor").size();
  for (const SweepScore& score : scores) width = std::max(width, score.variant.size());
  std::string out = fmt::format("{:{}}   yaw", "descriptor", width);
  for (const double left_m : kSweepLefts_m) out += fmt::format("  {:>3} m", left_m);
  out += '\n';
  for (const SweepScore& score : scores) {
    for (std::size_t y = 0; y < kSweepYaws_deg.size(); ++y) {
      out += fmt::format("{:{}}  {:>4}", y == 0 ? score.variant : "", width, kSweepYaws_deg[y]);
      for (const double recall : score.recall[y]) out += fmt::format("  {:.3f}", recall);
      out += '\n';
    }
  }
  if (scores.empty()) return out;
  return out +
         fmt::format(
             "Recall@1 within 10 m of {} revisits, described as seen after a turn (degrees) and from further left "
             "(m).\n",
             scores.front().queries);
}

std::string SweepJson(const std::vector<SweepScore>& scores) {
  using Json = nlohmann::ordered_json;
  Json variants = Json::array();
  for (const SweepScore& score : scores) {
    variants.push_back({{"descriptor", score.variant}, {"queries", score.queries}, {"recall_at_1", score.recall}});
  }
  const Json json = {{"yaw_deg", kSweepYaws_deg}, {"left_m", kSweepLefts_m}, {"descriptors", variants}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

// Over the lateral shift without a turn and after half a turn, and over the turn without a shift.
std::vector<report::LineChart> Charts(const std::vector<SweepScore>& scores) {
  const report::Axis left{"lateral shift (m)", kSweepLefts_m.front(), kSweepLefts_m.back(), 1};
  const report::Axis yaw{"turn (degrees)", kSweepYaws_deg.front(), kSweepYaws_deg.back(), 45};
  const report::Axis recall{"Recall@1 within 10 m", 0, 1, 0.2};
  std::vector<report::LineChart> charts = {{"same heading", left, recall, {}, true},
                                           {"turned by 180 degrees", left, recall, {}, true},
                                           {"turned on the spot", yaw, recall, {}, true}};
  for (const SweepScore& score : scores) {
    for (report::LineChart& chart : charts) chart.series.push_back({score.variant, {}});
    for (std::size_t i = 0; i < kSweepLefts_m.size(); ++i) {
      charts[0].series.back().points.push_back({kSweepLefts_m[i], score.recall.front()[i]});
      charts[1].series.back().points.push_back({kSweepLefts_m[i], score.recall.back()[i]});
    }
    for (std::size_t i = 0; i < kSweepYaws_deg.size(); ++i) {
      charts[2].series.back().points.push_back({kSweepYaws_deg[i], score.recall[i].front()});
    }
  }
  return charts;
}

void Run(Arguments arguments) {
  if (arguments.sweep.variants.empty()) arguments.sweep.variants = describe::VariantNames();
  for (const std::string& name : arguments.sweep.variants) describe::MakeVariant(name);
  arguments.sessions.radius_m = describe::kSubmapRadius_m + kSweepMargin_m;
  arguments.sweep.threads = arguments.sessions.threads;
  merge::TerminalProgress progress("eval");
  std::vector<describe::KeyframeSource> sources;
  ForEachSession(arguments.sessions, &progress,
                 [&](describe::KeyframeSource source) { sources.push_back(std::move(source)); });
  const std::vector<SweepScore> scores = SweepViewpoints(sources, arguments.sweep, &progress);
  progress.Finish();
  fmt::print("{}", arguments.json ? SweepJson(scores) : Table(scores));
  if (arguments.plot.empty()) return;
  const std::string note = report::WriteCharts(arguments.plot, Charts(scores));
  if (!note.empty()) fmt::print(stderr, "note: {}\n", note);
}

}  // namespace

void AddViewpointCommand(CLI::App& eval) {
  CLI::App* const command = eval.add_subcommand("viewpoint", "what turning and driving aside costs each descriptor");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("inputs", arguments->sessions.inputs, "recordings or .lcm logs of agents, sessions of one world")
      ->required();
  command->add_option("--variant", arguments->sweep.variants, fmt::format("{}; default: all", describe::VariantList()))
      ->delimiter(',');
  command->add_option("--truth-folder", arguments->sessions.truth_folder,
                      "NAME.tum for each recording or log: true positions instead of its own");
  command->add_option("--queries", arguments->sweep.most_queries, "more revisits than this are thinned evenly")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--threads", arguments->sessions.threads, "0: all of the machine; never changes the result")
      ->check(CLI::Range(0, 1024));
  command->add_option("--plot", arguments->plot, "write the curves as FILE.svg and FILE.png");
  command->add_flag("--json", arguments->json, "print JSON instead of a table");
  command->callback([arguments] { Run(*arguments); });
}

}  // namespace mapweld::eval
