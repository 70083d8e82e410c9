// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

#include "tools/serve/serve_output.hpp"

namespace mapweld::serve {
namespace {

volatile std::sig_atomic_t g_stop = 0;
void AskToStop(int) { g_stop = 1; }

constexpr double kMergeEvery = 2.0;        // seconds at least between two merges ...
constexpr double kMergeShare = 0.25;       // ... and at most this share of the time spent merging
constexpr std::uint64_t kNewKeyframes = 20;
constexpr int kMapSubmapStep = 4;          // every 20 m: submaps of 50 m radius cover the road with room to spare
constexpr std::size_t kPosesSentBack = 16;  // newest keyframes of a drive, the agent's window
constexpr double kFetchTimeout = 60.0;     // seconds without any progress

double Now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// The submaps of the drives of one snapshot. Copies nothing; the store only ever adds submaps, and std::map keeps them
// in place.
class StoredSubmaps final : public merge::SubmapSource {
 public:
  StoredSubmaps(FleetLink* link, const std::vector<DriveId>* ids) : link_(link), ids_(ids) {}
  const merge::SubmapCloud* Find(merge::SubmapKey key) override {
    return link_->WithStore([&](const FleetStore& store) {
      return store.FindSubmap((*ids_)[static_cast<std::size_t>(key.drive)], key.keyframe);
    });
  }

 private:
  FleetLink* link_;
  const std::vector<DriveId>* ids_;
};

class Silent final : public merge::Progress {
 public:
  void Report(std::string_view, int, int) override {}
};

}  // namespace

Server::Server(ServeOptions options)
    : options_(std::move(options)), link_(options_.lcm_url), requester_(&link_), started_s_(Now()) {
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
  FetchMapSubmaps(merged);
  WriteOutput(merged);
}

bool Server::IsDue() const {
  if (Now() - last_merge_s_ < std::max(kMergeEvery, merge_cost_s_ / kMergeShare)) return false;
  auto* const link = const_cast<FleetLink*>(&link_);
  const auto [keyframes, submaps] = link->WithStore([](const FleetStore& store) {
    return std::pair(store.counters().keyframes, store.counters().submaps);
  });
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

// Merges from nothing, fetching what the merge asks for, until it asks for nothing more: the result depends on what the
// agents drove, not on the order in which it came.
Server::Merged Server::MergeForGood() {
  for (;;) {
    merge::MergeCache fresh;
    Merged merged = MergeOnce(&fresh);
    if (merged.result.missing.empty() || g_stop > 1) return merged;
    WantMissing(merged);
    double last_progress = Now();
    std::size_t left = requester_.outstanding();
    while (left > 0 && Now() - last_progress < kFetchTimeout) {
      requester_.Step(Requester::Clock::now());
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      const std::size_t now_left = requester_.outstanding();
      if (now_left != left) last_progress = Now();
      left = now_left;
    }
    if (left > 0) {
      fmt::print(stderr, "serve: {} submaps did not arrive within {:.0f} s; merging without them\n", left, kFetchTimeout);
      return merged;
    }
  }
}

void Server::FetchMapSubmaps(const Merged& merged) {
  for (std::size_t d = 0; d < merged.fleet.ids.size(); ++d) {
    std::vector<std::int32_t> keyframes;
    for (std::size_t k = 0; k < merged.fleet.drives[d].keyframes.size(); k += kMapSubmapStep) {
      keyframes.push_back(static_cast<std::int32_t>(k));
    }
    requester_.Want(merged.fleet.ids[d], keyframes);
  }
  double last_progress = Now();
  std::size_t left = requester_.outstanding();
  while (left > 0 && Now() - last_progress < kFetchTimeout) {
    requester_.Step(Requester::Clock::now());
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const std::size_t now_left = requester_.outstanding();
    if (now_left != left) last_progress = Now();
    left = now_left;
  }
  if (left > 0) fmt::print(stderr, "serve: {} submaps of the map did not arrive; the map has gaps there\n", left);
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
