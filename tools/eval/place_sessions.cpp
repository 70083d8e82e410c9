// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/place_sessions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "tools/eval/trajectory_error.hpp"
#include "tools/io/tum.hpp"

namespace mapweld::eval {
namespace {

namespace fs = std::filesystem;
using describe::KeyframeSource;

KeyframeSource WithTruth(const fs::path& folder, KeyframeSource source) {
  const fs::path file = folder / (source.drive.name + ".tum");
  if (!fs::exists(file)) {
    throw std::runtime_error(fmt::format("{} is missing: the truth of {}", file.string(), source.drive.name));
  }
  const std::vector<io::StampedPose> truth = io::ReadTum(file);
  KeyframeSource out;
  out.drive.name = source.drive.name;
  std::vector<int> kept;
  for (std::size_t i = 0; i < source.drive.keyframes.size(); ++i) {
    geom::Pose3 world_T_body;
    if (!TruthAt(truth, source.drive.keyframes[i].t, &world_T_body)) continue;
    out.drive.keyframes.push_back(source.drive.keyframes[i]);
    out.scans.push_back(source.scans[i]);
    out.positions.push_back(world_T_body.t);
    kept.push_back(static_cast<int>(i));
  }
  if (kept.size() < source.scans.size()) {
    fmt::print(stderr, "note: {}: {} keyframes have no truth at their time and are left out\n", out.drive.name,
               source.scans.size() - kept.size());
  }
  out.submap = [kept = std::move(kept), all = std::move(source.submap)](int k) {
    return all(kept[static_cast<std::size_t>(k)]);
  };
  return out;
}

}  // namespace

void ForEachSession(const SessionArguments& arguments, merge::TerminalProgress* progress,
                    const std::function<void(KeyframeSource)>& visit) {
  const bool any_log = std::any_of(arguments.inputs.begin(), arguments.inputs.end(),
                                   [](const std::string& input) { return fs::path(input).extension() == ".lcm"; });
  const auto check = [&](std::size_t sessions) {
    if (arguments.truth_folder.empty() && any_log && sessions > 1) {
      throw std::runtime_error("each agent's log has a frame of its own; to compare several, give --truth-folder");
    }
  };
  check(arguments.inputs.size());
  std::size_t sessions = 0;
  for (const std::string& input : arguments.inputs) {
    progress->SetSubject(fs::path(input).filename().string());
    for (KeyframeSource& source : describe::OpenKeyframes(input, arguments.radius_m, arguments.threads, progress)) {
      check(++sessions);
      visit(arguments.truth_folder.empty() ? std::move(source) : WithTruth(arguments.truth_folder, std::move(source)));
    }
  }
  progress->SetSubject("");
}

}  // namespace mapweld::eval
