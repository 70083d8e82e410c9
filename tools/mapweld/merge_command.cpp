// SPDX-License-Identifier: Apache-2.0
#include "tools/mapweld/merge_command.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tools/mapweld/interrupt.hpp"
#include "tools/mapweld/merge_city.hpp"
#include "tools/mapweld/terminal_progress.hpp"
#include "tools/report/outcome.hpp"

namespace mapweld::merge {
namespace {

constexpr int kMapStep = 2;  // every second submap makes the map: 10 m apart, with 50 m of radius

struct MergeArguments {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path out;
  std::filesystem::path store;
  std::vector<std::string> truth;
  std::filesystem::path truth_folder;
  int threads = 0;
  bool sketches = false;
};

using Clock = std::chrono::steady_clock;
double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// NAME=FILE arguments, and NAME.tum or NAME.txt of the folder for every other drive.
std::map<std::string, std::filesystem::path> TruthOf(const MergeArguments& arguments,
                                                     const std::vector<merge::Drive>& drives) {
  std::map<std::string, std::filesystem::path> truth;
  for (const std::string& argument : arguments.truth) truth.insert(report::ParseTruth(argument));
  if (arguments.truth_folder.empty()) return truth;
  for (const merge::Drive& drive : drives) {
    for (const char* extension : {".tum", ".txt"}) {
      const std::filesystem::path file = arguments.truth_folder / (drive.name + extension);
      if (std::filesystem::exists(file)) truth.emplace(drive.name, file);
    }
  }
  if (truth.empty()) {
    throw std::runtime_error(fmt::format("{} holds no truth: no NAME.tum or NAME.txt of any drive, for example {}.tum",
                                         arguments.truth_folder.string(), drives.front().name));
  }
  return truth;
}

void RunMerge(const MergeArguments& arguments, const MakeCrew& make_crew) {
  if (arguments.inputs.empty() && arguments.store.empty()) {
    throw std::runtime_error("merge: name some recordings, or a --store that holds some");
  }
  if (make_crew && !arguments.store.empty()) {
    throw std::runtime_error("merge: a store is kept by one process; merge without --store");
  }
  const CleanInterrupt interrupt(arguments.store.empty()
                                     ? "merge: interrupted"
                                     : "merge: interrupted; the same command goes on where this one was");
  TerminalProgress progress("merge");
  const std::unique_ptr<Crew> crew = make_crew ? make_crew(&progress) : nullptr;
  if (crew != nullptr && !crew->Leads()) progress.Silence();
  const auto begin = Clock::now();
  const std::vector<MergeInput> inputs = OpenInputs(arguments.inputs, arguments.threads, &progress);
  const std::unique_ptr<MergeCity> city =
      arguments.store.empty() ? CityInMemory(inputs, crew.get()) : CityInStore(arguments.store, inputs, &progress);
  const std::map<std::string, std::filesystem::path> truth = TruthOf(arguments, city->drives());
  progress.SetSubject("");
  const double build_s = SecondsSince(begin);

  MergeConfig config;
  config.threads = arguments.threads;
  config.association.sketches = arguments.sketches;
  const MergeResult result = city->Merge(config, &progress);
  if (crew != nullptr && !crew->Leads()) return;

  report::OutcomeInput outcome;
  outcome.title = fmt::format("Map of {} recordings", city->drives().size());
  outcome.drives = &city->drives();
  outcome.result = &result;
  ThinnedSubmaps map_submaps(city.get(), kMapStep);
  outcome.submaps = &map_submaps;
  outcome.truth = truth;
  outcome.seconds = {{"submaps", build_s}};
  outcome.trajectories = city->Trajectories(result);
  progress.Finish();
  const report::Summary summary = report::WriteOutcome(arguments.out, std::move(outcome));
  fmt::print("{}report: {}\n", report::SummaryTable(summary), (arguments.out / "report.html").string());
}

}  // namespace

void AddMergeCommand(CLI::App& app, MakeCrew make_crew) {
  CLI::App* const command =
      app.add_subcommand("merge", "Merge recordings of any LiDAR odometry, or LCM logs of Mapweld's agents");
  const auto arguments = std::make_shared<MergeArguments>();
  command->add_option("recordings", arguments->inputs,
                      "folders (KITTI layout, or PCD/PLY clouds with a TUM trajectory) and .lcm logs");
  command->add_option("-o,--out", arguments->out, "folder for map, trajectories and report.html")->required();
  command->add_option(
      "--store", arguments->store,
      "file that keeps the city: merges these recordings with all that it holds, and does nothing twice");
  command->add_option("--truth", arguments->truth,
                      "NAME=FILE: true trajectory of a recording, for the errors in the report");
  command->add_option("--truth-folder", arguments->truth_folder,
                      "folder with NAME.tum (or KITTI NAME.txt) for --truth");
  command->add_flag("--sketches", arguments->sketches,
                    "for many drives: compare only pairs whose 256-bit sketches agree; may lose short meetings");
  command->add_option("--threads", arguments->threads, "0: all of the machine; never changes the result")
      ->check(CLI::Range(0, 1024));
  command->callback([arguments, make_crew = std::move(make_crew)] { RunMerge(*arguments, make_crew); });
}

}  // namespace mapweld::merge
