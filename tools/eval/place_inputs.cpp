// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/place_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tools/describe/described_drive.hpp"
#include "tools/describe/variants.hpp"
#include "tools/eval/place_sessions.hpp"

namespace mapweld::eval {
namespace {

namespace fs = std::filesystem;
using describe::DescribedDrive;
using describe::PlaceMethod;
using describe::PlaceRow;

// Rows of one session after the other become one task.
class TaskBuilder {
 public:
  TaskBuilder(std::string variant, std::shared_ptr<const PlaceMethod> method) {
    task_.variant = std::move(variant);
    task_.method = std::move(method);
  }
  void AddSession(const std::string& name, const std::vector<PlaceRow>& rows, std::optional<int> unfamiliar) {
    std::vector<geom::Vec3d> positions;
    for (const PlaceRow& row : rows) {
      const bool valid = row.place.descriptor.scale > 0;
      positions.push_back(row.position);
      task_.features.push_back(valid ? task_.method->Prepare(row.place) : PlaceMethod::Features{});
      task_.refused += valid ? 0 : 1;
    }
    if (unfamiliar) task_.unfamiliar = task_.unfamiliar.value_or(0) + *unfamiliar;
    set_->AddSession(name, positions);
  }
  PlaceTask Take() {
    task_.set = set_;
    return std::move(task_);
  }

 private:
  PlaceTask task_;
  std::shared_ptr<PlaceSet> set_ = std::make_shared<PlaceSet>();
};

struct NamedTable {
  std::string name;
  fs::path file;
};

NamedTable ParseTable(const std::string& input) {
  const std::size_t equals = input.find('=');
  if (equals == std::string::npos) return {fs::path(input).stem().string(), input};
  return {input.substr(0, equals), input.substr(equals + 1)};
}

std::vector<PlaceTask> TasksOfTables(const std::vector<std::string>& inputs) {
  std::vector<std::pair<std::string, TaskBuilder>> builders;
  for (const std::string& input : inputs) {
    const NamedTable table = ParseTable(input);
    auto at = std::find_if(builders.begin(), builders.end(), [&](const auto& b) { return b.first == table.name; });
    if (at == builders.end()) {
      std::shared_ptr<const PlaceMethod> method =
          describe::IsVariant(table.name) ? describe::MakeVariant(table.name) : describe::MakeCosineComparison();
      builders.emplace_back(table.name, TaskBuilder(table.name, std::move(method)));
      at = builders.end() - 1;
    }
    at->second.AddSession(table.file.string(), describe::ReadPlaceTable(table.file), std::nullopt);
  }
  std::vector<PlaceTask> tasks;
  for (auto& [name, builder] : builders) tasks.push_back(builder.Take());
  return tasks;
}

std::vector<PlaceTask> TasksOfRecordings(const std::vector<std::string>& inputs, const PlaceArguments& arguments,
                                         merge::TerminalProgress* progress) {
  const std::vector<std::string> variants = arguments.variants.empty() ? describe::VariantNames() : arguments.variants;
  std::vector<TaskBuilder> builders;
  for (const std::string& name : variants) {
    builders.emplace_back(
        name, name == describe::kPublished ? describe::MakeCosineComparison() : describe::MakeVariant(name));
  }
  for (const std::string& input : inputs) describe::CheckVariants(input, variants);
  SessionArguments sessions;
  sessions.inputs = inputs;
  sessions.truth_folder = arguments.truth_folder;
  sessions.threads = arguments.threads;
  ForEachSession(sessions, progress, [&](const describe::KeyframeSource& source) {
    const DescribedDrive drive = describe::DescribeKeyframes(source, variants, arguments.threads, progress);
    for (std::size_t v = 0; v < variants.size(); ++v) {
      builders[v].AddSession(drive.name, drive.variants[v], drive.unfamiliar[v]);
    }
  });
  std::vector<PlaceTask> tasks;
  for (TaskBuilder& builder : builders) tasks.push_back(builder.Take());
  return tasks;
}

}  // namespace

std::vector<PlaceTask> LoadPlaceTasks(const PlaceArguments& arguments, merge::TerminalProgress* progress) {
  std::vector<std::string> tables;
  std::vector<std::string> recordings;
  for (const std::string& input : arguments.inputs) {
    (input.ends_with(".csv") ? tables : recordings).push_back(input);
  }
  if (recordings.empty() && !arguments.variants.empty()) {
    throw std::runtime_error("--variant is for recordings and logs; what is in a table is said by NAME=FILE.csv");
  }
  std::vector<PlaceTask> tasks = TasksOfTables(tables);  // first: mistakes in them are found at once
  if (recordings.empty()) return tasks;
  std::vector<PlaceTask> all = TasksOfRecordings(recordings, arguments, progress);
  std::move(tasks.begin(), tasks.end(), std::back_inserter(all));
  return all;
}

}  // namespace mapweld::eval
