// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/places_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/describe/variants.hpp"
#include "tools/eval/place_inputs.hpp"
#include "tools/report/line_chart.hpp"

namespace mapweld::eval {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::array kDirectionNames = {"forward", "reverse", "crossing"};

// A share, or a dash where nothing was asked.
std::string Share(const Recall& recall, std::size_t rank) {
  return recall.queries > 0 ? fmt::format("{:.3f}", recall.at[rank]) : "-";
}

Json RecallJson(const Recall& recall) {
  Json json = {{"queries", recall.queries}};
  for (std::size_t n = 0; n < kRecallRanks.size(); ++n)
    json[fmt::format("recall_at_{}", kRecallRanks[n])] = recall.at[n];
  return json;
}

Json RadiusJson(const RadiusScore& score) {
  Json json = {{"radius_m", score.radius_m}, {"all", RecallJson(score.all)}};
  for (std::size_t d = 0; d < kDirectionNames.size(); ++d) json[kDirectionNames[d]] = RecallJson(score.by_direction[d]);
  json["f1_max"] = score.f1_max;
  json["extended_precision"] = score.extended_precision;
  json["auc"] = score.auc;
  Json curve = Json::array();
  for (const PrecisionRecall& p : score.curve) curve.push_back({p.threshold, p.precision, p.recall});
  json["curve_threshold_precision_recall"] = std::move(curve);
  return json;
}

VariantScore Score(const PlaceTask& task, int threads, merge::TerminalProgress* progress) {
  progress->SetSubject(task.variant);
  const auto distance = [&](int query, int candidate) {
    const auto& a = task.features[static_cast<std::size_t>(query)];
    const auto& b = task.features[static_cast<std::size_t>(candidate)];
    return a.empty() || b.empty() ? std::numeric_limits<float>::infinity() : task.method->Distance(a, b);
  };
  return {task.variant, task.set->sessions(), task.set->size(),
          task.refused, task.unfamiliar,      ScorePlaces(*task.set, distance, threads, progress)};
}

// Precision over recall, and recall over the number of candidates looked at.
std::vector<report::LineChart> Charts(const std::vector<VariantScore>& scores) {
  report::LineChart curves{
      "best matches, hits within 10 m", {"recall", 0, 1, 0.2}, {"precision", 0, 1, 0.2}, {}, false};
  report::LineChart recalls{"among the nearest N", {"N", 0, 20, 5}, {"Recall@N", 0, 1, 0.2}, {}, true};
  for (const VariantScore& s : scores) {
    curves.series.push_back({s.variant, {}});
    for (const PrecisionRecall& p : s.score[1].curve) curves.series.back().points.push_back({p.recall, p.precision});
    recalls.series.push_back({s.variant, {}});
    for (std::size_t n = 0; n < kRecallRanks.size(); ++n) {
      recalls.series.back().points.push_back({static_cast<double>(kRecallRanks[n]), s.score[1].all.at[n]});
    }
  }
  return {curves, recalls};
}

void Run(const PlaceArguments& arguments, const std::filesystem::path& plot, bool json) {
  merge::TerminalProgress progress("eval");
  std::vector<VariantScore> scores;
  for (const PlaceTask& task : LoadPlaceTasks(arguments, &progress)) {
    scores.push_back(Score(task, arguments.threads, &progress));
  }
  progress.Finish();
  fmt::print("{}", json ? PlaceJson(scores) : PlaceTable(scores));
  if (plot.empty()) return;
  const std::string note = report::WriteCharts(plot, Charts(scores));
  if (!note.empty()) fmt::print(stderr, "note: {}\n", note);
}

}  // namespace

std::string PlaceTable(const std::vector<VariantScore>& scores) {
  std::size_t width = std::string_view("descriptor").size();
  for (const VariantScore& s : scores) width = std::max(width, s.variant.size());
  std::string out = fmt::format(
      "{:{}}  keyframes  queries   R@1   R@5  R@10  R@20   forward       reverse       crossing       F1max    EP   AUC"
      "   5 m  25 m\n",
      "descriptor", width);
  for (const VariantScore& s : scores) {
    const RadiusScore& at = s.score[1];
    out += fmt::format("{:{}}  {:>9}  {:>7}", s.variant, width, s.keyframes, at.all.queries);
    for (std::size_t n = 0; n < kRecallRanks.size(); ++n) out += fmt::format(" {:>5}", Share(at.all, n));
    for (const Recall& recall : at.by_direction) {
      out += fmt::format("   {:>5} {:<6}", Share(recall, 0), fmt::format("({})", recall.queries));
    }
    out += fmt::format("  {:.3f} {:.3f} {:.3f} {:>5} {:>5}\n", at.f1_max, at.extended_precision, at.auc,
                       Share(s.score[0].all, 0), Share(s.score[2].all, 0));
  }
  const bool several = !scores.empty() && scores.front().sessions > 1;
  out += fmt::format(
      "A query is a keyframe with {} within 10 m; R@N: one of them is among the N nearest descriptors.\n"
      "forward, reverse, crossing: R@1 of the revisits (their number) below 60, above 120 and between these degrees.\n"
      "F1max, EP (extended precision), AUC: of the best matches of all keyframes. 5 m, 25 m: R@1 within these radii.\n",
      several ? "one of another session" : "one at least 60 m of path earlier");
  for (const VariantScore& s : scores) {
    if (s.refused > 0) {
      out += fmt::format("{}: {} keyframes have no descriptor and count as missed.\n", s.variant, s.refused);
    }
    if (s.unfamiliar.value_or(0) > 0) {
      out += fmt::format("{}: {} keyframes look unlike the places it was trained on.\n", s.variant, *s.unfamiliar);
    }
  }
  return out;
}

std::string PlaceJson(const std::vector<VariantScore>& scores) {
  Json json = Json::array();
  for (const VariantScore& s : scores) {
    Json radii = Json::array();
    for (const RadiusScore& score : s.score) radii.push_back(RadiusJson(score));
    json.push_back({{"descriptor", s.variant},
                    {"sessions", s.sessions},
                    {"keyframes", s.keyframes},
                    {"without_descriptor", s.refused},
                    {"unlike_training", s.unfamiliar ? Json(*s.unfamiliar) : Json()},
                    {"radii", std::move(radii)}});
  }
  return Json{{"descriptors", std::move(json)}}.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

void AddPlacesCommand(CLI::App& eval) {
  CLI::App* const command = eval.add_subcommand("places", "how well descriptors recognise places");
  const auto arguments = std::make_shared<PlaceArguments>();
  const auto plot = std::make_shared<std::filesystem::path>();
  const auto json = std::make_shared<bool>(false);
  command
      ->add_option(
          "inputs", arguments->inputs,
          "tables of mapweld describe ([NAME=]FILE.csv), recordings, or .lcm logs of agents. Tables of one "
          "NAME, and all recordings, are sessions of one world; a NAME that is a descriptor compares as it does")
      ->required();
  command
      ->add_option("--variant", arguments->variants,
                   fmt::format("for recordings and logs: {}, published (what agents sent); default: all but the last",
                               describe::VariantList()))
      ->delimiter(',');
  command->add_option("--truth-folder", arguments->truth_folder,
                      "NAME.tum for each recording or log: true positions instead of its own");
  command->add_option("--threads", arguments->threads, "0: all of the machine; never changes the result")
      ->check(CLI::Range(0, 1024));
  command->add_option("--plot", *plot, "write the curves as FILE.svg and FILE.png");
  command->add_flag("--json", *json, "print JSON instead of a table");
  command->callback([arguments, plot, json] { Run(*arguments, *plot, *json); });
}

}  // namespace mapweld::eval
