// SPDX-License-Identifier: Apache-2.0
#include "tools/describe/describe_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/describe/described_drive.hpp"
#include "tools/describe/variants.hpp"
#include "tools/mapweld/terminal_progress.hpp"

namespace mapweld::describe {
namespace {

struct Arguments {
  std::filesystem::path recording;
  std::filesystem::path out;
  std::string variant;
  int threads = 0;
};

void Run(const Arguments& arguments) {
  const bool is_log = arguments.recording.extension() == ".lcm";
  std::string variant = arguments.variant;
  if (variant.empty()) variant = is_log ? kPublished : VariantNames().front();
  CheckVariants(arguments.recording, {variant});
  merge::TerminalProgress progress("describe");
  const std::vector<KeyframeSource> sources =
      OpenKeyframes(arguments.recording, kSubmapRadius_m, arguments.threads, &progress);
  if (sources.size() > 1) {
    throw std::runtime_error(fmt::format("{} holds {} drives, and a table is of one; split the log by agent",
                                         arguments.recording.string(), sources.size()));
  }
  const DescribedDrive drive = DescribeKeyframes(sources[0], {variant}, arguments.threads, &progress);
  progress.Finish();
  WritePlaceTable(arguments.out, drive.variants[0]);
  fmt::print("{}: {} keyframes by {}", arguments.out.string(), drive.variants[0].size(), variant);
  if (drive.refused[0] > 0) fmt::print("; {} of them have nothing to describe (scale 0)", drive.refused[0]);
  if (drive.unfamiliar[0] > 0) fmt::print("; {} look unlike the places it was trained on", drive.unfamiliar[0]);
  fmt::print("\n");
}

}  // namespace

void AddDescribeCommand(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("describe", "Write the place descriptor of every keyframe as a table");
  const auto arguments = std::make_shared<Arguments>();
  command
      ->add_option("recording", arguments->recording,
                   "folder (KITTI layout, or PCD/PLY clouds with a TUM trajectory) or .lcm log of an agent")
      ->required();
  command->add_option("-o,--out", arguments->out, "table to write: scan,x,y,z,scale,d0,...,d1023,o0,...,o191")
      ->required();
  command->add_option("--variant", arguments->variant,
                      fmt::format("{}; or {} (default for a log): what the agent sent", VariantList(), kPublished));
  command->add_option("--threads", arguments->threads, "0: all of the machine; never changes the result")
      ->check(CLI::Range(0, 1024));
  command->callback([arguments] { Run(*arguments); });
}

}  // namespace mapweld::describe
