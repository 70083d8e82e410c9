// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

#include "tools/report/outcome.hpp"
#include "tools/serve/serve_output.hpp"

namespace mapweld::serve {
namespace {

volatile std::sig_atomic_t g_stop = 0;
void AskToStop(int) {
  g_stop = 1;
}

constexpr double kMergeEvery = 2.0;   // seconds at least between two merges ...
constexpr double kMergeShare = 0.25;  // ... and at most this share of the time spent merging
constexpr std::uint64_t kNewKeyframes = 20;
constexpr std::size_t kPosesSentBack = 16;  // newest keyframes of a drive, the agent's window
constexpr double kFetchTimeout = 60.0;      // seconds without any progress

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class Silent final : public merge::Progress {
 public:
  void Report(std::string_view, int, int) override {}
};

}  // namespace

Server::Server(ServeOptions options)
    : options_(std::move(options)), link_(options_.lcm_url), requester_(&link_), started_s_(Now()) {
  // Submaps travel over the air: all pairs of drives are content with the few that also make the map.
  options_.merge.verify.keyframe_stride = kMapStep;
  options_.merge.verify.step_m = kMapStep * 5.0;
  options_.merge.refine.step_m = kMapStep * 5.0;
  std::signal(SIGINT, AskToStop);
  std::signal(SIGTERM, AskToStop);
}

void Server::Run() {
  while (g_stop == 0 && !AllEnded()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    requester_.Step(Requester::Clock::now());
    ReportProgress();
    if (!IsDue()) continue;
    const double begin = Now();
    const Merged merged = MergeOnce(&cache_);
    merge_cost_s_ = Now() - begin;
    last_merge_s_ = Now();
    WantMissing(merged);
    SendBack(merged);
  }
  drives_ended_s_ = Now();
  const Merged merged = MergeForGood();
  if (merged.fleet.drives.empty()) {
    std::fputs("serve: ended without a single keyframe; nothing to merge\n", stderr);
    return;
  }
  SendBack(merged);
  FetchMap(merged);
  fetched_s_ = Now();
  WriteOutput(merged);
}

bool Server::IsDue() {
  if (Now() - last_merge_s_ < std::max(kMergeEvery, merge_cost_s_ / kMergeShare)) return false;
  const auto [keyframes, submaps] = link_.WithStore(
      [](const FleetStore& store) { return std::pair(store.counters().keyframes, store.counters().submaps); });
  return keyframes >= merged_keyframes_ + kNewKeyframes || submaps > merged_submaps_;
}

bool Server::AllEnded() {
  if (options_.agents == 0) return false;
  return link_.WithStore([&](const FleetStore& store) {
    const auto ids = store.Ids();
    return std::count_if(ids.begin(), ids.end(), [&](const DriveId& id) { return store.IsComplete(id); }) >=
           options_.agents;
  });
}

Server::Merged Server::MergeOnce(merge::MergeCache* cache) {
  Merged merged;
  link_.WithStore([&](const FleetStore& store) {
    merged.fleet = store.Drives();
    merged_keyframes_ = store.counters().keyframes;
    merged_submaps_ = store.counters().submaps;
  });
  StoredSubmaps submaps(&link_, &merged.fleet.ids);
  Silent silent;
  merged.result = merge::MergeDrives(merged.fleet.drives, submaps, options_.merge, &silent, cache);
  ++revision_;
  return merged;
}

void Server::WantMissing(const Merged& merged) {
  std::map<DriveId, std::vector<std::int32_t>> wanted;
  for (const DriveId& id : merged.fleet.ids) wanted[id] = {};
  for (const merge::SubmapKey& key : merged.result.missing) {
    wanted[merged.fleet.ids[static_cast<std::size_t>(key.drive)]].push_back(key.keyframe);
  }
  for (const auto& [id, keyframes] : wanted) requester_.Want(id, keyframes);
}

void Server::SendBack(const Merged& merged) {
  for (std::size_t d = 0; d < merged.fleet.ids.size(); ++d) {
    const int group = merged.result.group_of[d];
    // A drive on its own is in no merged map yet.
    if (group < 0 || merged.result.groups[static_cast<std::size_t>(group)].size() < 2) continue;
    const auto& poses = merged.result.merged_T_body[d];
    std::vector<MergedKeyframe> back;
    for (std::size_t k = poses.size() - std::min(poses.size(), kPosesSentBack); k < poses.size(); ++k) {
      back.push_back({static_cast<std::int32_t>(k), group, poses[k]});
    }
    link_.SendMergedPoses(merged.fleet.ids[d], revision_, back);
  }
}

// Until every wanted submap is there, or nothing has come for kFetchTimeout. Gives the number still missing.
std::size_t Server::Fetch() {
  double last_progress = Now();
  std::size_t left = requester_.outstanding();
  while (left > 0 && g_stop == 0 && Now() - last_progress < kFetchTimeout) {
    requester_.Step(Requester::Clock::now());
    ReportProgress();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const std::size_t now_left = requester_.outstanding();
    if (now_left != left) last_progress = Now();
    left = now_left;
  }
  return left;
}

// Merges from nothing, fetching what the merge asks for, until it asks for nothing more: the result depends on what the
// agents drove, not on the order in which it came.
Server::Merged Server::MergeForGood() {
  for (;;) {
    merge::MergeCache fresh;
    Merged merged = MergeOnce(&fresh);
    WantMissing(merged);
    const std::size_t left = Fetch();
    if (left > 0) fmt::print(stderr, "serve: {} submaps did not arrive; merging without them\n", left);
    if (left > 0 || merged.result.missing.empty()) return merged;
  }
}

void Server::FetchMap(const Merged& merged) {
  for (std::size_t d = 0; d < merged.fleet.ids.size(); ++d) {
    std::vector<std::int32_t> keyframes;
    for (std::size_t k = 0; k < merged.fleet.drives[d].keyframes.size(); k += kMapStep) {
      keyframes.push_back(static_cast<std::int32_t>(k));
    }
    requester_.Want(merged.fleet.ids[d], keyframes);
  }
  const std::size_t left = Fetch();
  if (left > 0) fmt::print(stderr, "serve: {} submaps of the map did not arrive; the map has gaps there\n", left);
}

void Server::WriteOutput(const Merged& merged) {
  StoredSubmaps stored(&link_, &merged.fleet.ids);
  merge::ThinnedSubmaps submaps(&stored, kMapStep);
  report::OutcomeInput input;
  input.title = fmt::format("Map of {} vehicles", merged.fleet.drives.size());
  input.drives = &merged.fleet.drives;
  input.result = &merged.result;
  input.submaps = &submaps;
  input.truth = options_.truth;
  input.traffic = Traffic(&link_, merged.fleet.ids);
  input.seconds = {{"drives", drives_ended_s_ - started_s_}, {"submaps", fetched_s_ - drives_ended_s_}};
  const report::Summary summary = report::WriteOutcome(options_.out, std::move(input));
  fmt::print("{}report: {}\n", report::SummaryTable(summary), (options_.out / "report.html").string());
}

void Server::ReportProgress() {
  if (Now() - last_progress_s_ < 2.0) return;
  last_progress_s_ = Now();
  std::string line;
  link_.WithStore([&](const FleetStore& store) {
    for (const DriveId& id : store.Ids()) {
      const auto health = store.Health(id);
      if (health.has_value()) line += fmt::format("  {} {:.0f} m", DriveName(id), health->path_m);
    }
    line += fmt::format("  | {} keyframes, {} submaps, merge {}", store.counters().keyframes, store.counters().submaps,
                        revision_);
  });
  fmt::print(stderr, "serve:{}\n", line);
}

}  // namespace mapweld::serve
