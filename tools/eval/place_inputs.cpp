// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/place_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tools/describe/described_drive.hpp"
#include "tools/describe/variants.hpp"
#include "tools/eval/trajectory_error.hpp"
#include "tools/io/tum.hpp"

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
  void AddSession(const std::string& name, const std::vector<PlaceRow>& rows) {
    std::vector<geom::Vec3d> positions;
    for (const PlaceRow& row : rows) {
      const bool valid = row.place.descriptor.scale > 0;
      positions.push_back(row.position);
      task_.features.push_back(valid ? task_.method->Prepare(row.place) : PlaceMethod::Features{});
      task_.refused += valid ? 0 : 1;
    }
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

// Puts the truth in place of the positions and drops keyframes at times without truth.
void TakeTruth(const fs::path& folder, DescribedDrive* drive) {
  const fs::path file = folder / (drive->name + ".tum");
  if (!fs::exists(file))
    throw std::runtime_error(fmt::format("{} is missing: the truth of {}", file.string(), drive->name));
  const std::vector<io::StampedPose> truth = io::ReadTum(file);
  std::size_t dropped = 0;
  for (std::vector<PlaceRow>& rows : drive->variants) {
    std::vector<PlaceRow> kept;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      geom::Pose3 world_T_body;
      if (!TruthAt(truth, drive->times[i], &world_T_body)) continue;
      kept.push_back(rows[i]);
      kept.back().position = world_T_body.t;
    }
    dropped = rows.size() - kept.size();
    rows = std::move(kept);
  }
  if (dropped > 0) fmt::print(stderr, "note: {}: {} keyframes have no truth at their time\n", drive->name, dropped);
}

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
    at->second.AddSession(table.file.string(), describe::ReadPlaceTable(table.file));
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
  int logs = 0;
  int drives = 0;
  for (const std::string& input : inputs) {
    logs += fs::path(input).extension() == ".lcm" ? 1 : 0;
    progress->SetSubject(fs::path(input).filename().string());
    for (DescribedDrive& drive : describe::DescribeDrives(input, variants, arguments.threads, progress)) {
      if (!arguments.truth_folder.empty()) TakeTruth(arguments.truth_folder, &drive);
      for (std::size_t v = 0; v < variants.size(); ++v) builders[v].AddSession(drive.name, drive.variants[v]);
      ++drives;
      if (logs > 0 && drives > 1 && arguments.truth_folder.empty()) {
        throw std::runtime_error("each log of an agent has a frame of its own; several need --truth-folder");
      }
    }
  }
  progress->SetSubject("");
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
