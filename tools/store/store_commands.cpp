// SPDX-License-Identifier: Apache-2.0
#include "tools/store/store_commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tools/store/explain.hpp"
#include "tools/store/fsck.hpp"
#include "tools/store/history.hpp"

namespace mapweld::store {
namespace {

struct Arguments {
  std::filesystem::path store;
  std::string a;
  std::string b;
  bool release = false;
  bool json = false;
};

CLI::App* AddCommand(CLI::App& app, const std::string& name, const std::string& help,
                     const std::shared_ptr<Arguments>& arguments, void (*run)(const Arguments&)) {
  CLI::App* const command = app.add_subcommand(name, help);
  command->add_option("store", arguments->store, "the city's file, as given to merge --store or serve --store")
      ->required();
  command->callback([arguments, run] { run(*arguments); });
  return command;
}

CityStore Open(const Arguments& arguments) {
  return CityStore(arguments.store, Database::Mode::kExisting);
}

void RunFsck(const Arguments& arguments) {
  CityStore store = Open(arguments);
  const FsckReport report = Fsck(&store);
  fmt::print("{}", arguments.json ? ToJson(report) : ToText(report, arguments.store.string()));
  if (!report.Clean()) {
    throw StoreError(fmt::format("{} is not what was written; what is damaged is left out when it is used",
                                 arguments.store.string()));
  }
}

std::string Counted(std::size_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

std::string GroupSizes(const MergeRecord& record) {
  std::string text;
  for (const auto& group : record.groups) text += (text.empty() ? "" : " + ") + std::to_string(group.size());
  return text;
}

void RunHistory(const Arguments& arguments) {
  CityStore store = Open(arguments);
  const std::vector<NumberedMerge> merges = Merges(&store);
  const MergeRecord* before = nullptr;
  for (const NumberedMerge& merge : merges) {
    const MergeRecord& record = merge.record;
    std::size_t accepted = 0;
    for (const merge::Overlap& overlap : record.overlaps) accepted += overlap.accepted ? 1 : 0;
    fmt::print("{:4}  {} UTC  {}: {} in {} ({}), {}\n", merge.number, record.when, record.cause,
               Counted(record.drives.size(), "drive"), Counted(record.groups.size(), "group"), GroupSizes(record),
               Counted(accepted, "overlap"));
    for (const std::string& change : Changes(before, record)) fmt::print("        {}\n", change);
    before = &record;
  }
  if (merges.empty()) fmt::print("{}: no merge yet\n", arguments.store.string());
  for (const NumberedRuling& ruling : Rulings(&store)) {
    const bool pair = ruling.ruling.kind == Ruling::Kind::kRefusePair;
    fmt::print("ruling of {} UTC: {}{} {}\n", ruling.ruling.when, ruling.ruling.drive_a,
               pair ? " and " + ruling.ruling.drive_b : "", pair ? "are not joined" : "is left out");
  }
}

void RunExplain(const Arguments& arguments) {
  CityStore store = Open(arguments);
  fmt::print("{}", Explain(&store, arguments.a, arguments.b));
}

constexpr const char* kNextMerge = "the next merge keeps to it: mapweld merge --store";

void RunUndo(const Arguments& arguments) {
  CityStore store = Open(arguments);
  for (const auto& [a, b] : Undo(&store, TimeLabel())) fmt::print("{} and {} are not joined any more\n", a, b);
  fmt::print("{} {} -o OUT; 'mapweld withdraw {} A B --release' allows a pair again\n", kNextMerge,
             arguments.store.string(), arguments.store.string());
}

void Apply(CityStore* store, const Ruling& ruling, bool release, const std::string& sentence) {
  if (release && !RemoveRuling(store, ruling)) {
    throw StoreError(
        fmt::format("there is no such ruling in {}; 'mapweld history' lists them", store->database().path().string()));
  }
  if (!release) AddRuling(store, ruling);
  fmt::print("{}; {} {} -o OUT\n", sentence, kNextMerge, store->database().path().string());
}

void RunWithdraw(const Arguments& arguments) {
  CityStore store = Open(arguments);
  Ruling ruling{Ruling::Kind::kRefusePair, std::min(arguments.a, arguments.b), std::max(arguments.a, arguments.b),
                TimeLabel()};
  Apply(&store, ruling, arguments.release,
        fmt::format("{} and {} are {}", ruling.drive_a, ruling.drive_b,
                    arguments.release ? "judged by their evidence again" : "never joined directly"));
}

void RunQuarantine(const Arguments& arguments) {
  CityStore store = Open(arguments);
  // An agent's name means all its drives.
  std::vector<std::string> names;
  for (const StoredDrive& drive : store.Drives()) {
    const bool of_agent = drive.info.agent != 0 && arguments.a == fmt::format("agent_{}", drive.info.agent);
    if (of_agent || drive.info.name == arguments.a) names.push_back(drive.info.name);
  }
  if (names.empty()) names.push_back(arguments.a);  // told by AddRuling
  for (const std::string& name : names) {
    Apply(&store, {Ruling::Kind::kQuarantine, name, "", TimeLabel()}, arguments.release,
          fmt::format("{} is {}", name, arguments.release ? "merged again" : "left out"));
  }
}

}  // namespace

void AddStoreCommands(CLI::App& app) {
  const auto arguments = std::make_shared<Arguments>();
  AddCommand(app, "fsck", "Check a city's file: structure, checksums, references; exit code 1 when damaged", arguments,
             RunFsck)
      ->add_flag("--json", arguments->json, "for programs");
  AddCommand(app, "history", "List the merges of a city and what each joined or split", arguments, RunHistory);
  CLI::App* const explain =
      AddCommand(app, "explain", "Say why two drives are, or are not, in one map", arguments, RunExplain);
  CLI::App* const withdraw =
      AddCommand(app, "withdraw", "Refuse the overlap of two drives by hand", arguments, RunWithdraw);
  for (CLI::App* const command : {explain, withdraw}) {
    command->add_option("a", arguments->a, "a drive")->required();
    command->add_option("b", arguments->b, "the other")->required();
  }
  CLI::App* const quarantine = AddCommand(
      app, "quarantine", "Leave a drive, or all drives of an agent, out of the merge", arguments, RunQuarantine);
  quarantine->add_option("drive", arguments->a, "a drive, or agent_N for all boots of one")->required();
  for (CLI::App* const command : {withdraw, quarantine}) {
    command->add_flag("--release", arguments->release, "take the ruling back");
  }
  AddCommand(app, "undo", "Take back what the newest merge joined", arguments, RunUndo);
}

}  // namespace mapweld::store
