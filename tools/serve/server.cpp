// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "tools/report/outcome.hpp"
#include "tools/serve/serve_output.hpp"
#include "tools/serve/submap_value.hpp"
#include "tools/store/pair_memory.hpp"

namespace mapweld::serve {
namespace {

volatile std::sig_atomic_t g_stop = 0;
void AskToStop(int signal) {
  g_stop = 1;
  std::signal(signal, SIG_DFL);
}

constexpr double kMergeEvery = 2.0;   // seconds at least between two merges ...
constexpr double kMergeShare = 0.25;  // ... and at most this share of the time spent merging
constexpr std::uint64_t kNewKeyframes = 20;
constexpr std::size_t kPosesSentBack = 16;  // newest keyframes of a drive, the agent's window
constexpr double kFetchTimeout = 60.0;      // seconds without any progress
constexpr std::chrono::milliseconds kBusyPause{20};
constexpr std::chrono::milliseconds kIdlePause{500};

// Of an agent's correction: it takes none that is older than what it has, also from a host that has started again.
std::int32_t FirstRevision() {
  constexpr std::int64_t kYear2020_s = 1'577'836'800;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::int32_t>(std::chrono::duration_cast<std::chrono::seconds>(now).count() - kYear2020_s);
}

std::unique_ptr<store::CityStore> OpenStore(const std::filesystem::path& path) {
  return path.empty() ? nullptr : std::make_unique<store::CityStore>(path);
}

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class Silent final : public merge::Progress {
 public:
  void Report(std::string_view, int, int) override {}
};

}  // namespace

Server::Server(ServeOptions options)
    : options_(std::move(options)),
      city_(OpenStore(options_.store)),
      link_(options_.lcm_url, city_.get()),
      requester_(&link_, options_.submap_bytes_per_s),
      revision_(FirstRevision()),
      started_s_(Now()) {
  // Submaps travel over the air: all pairs of drives are content with the few that also make the map.
  options_.merge.verify.keyframe_stride = kMapStep;
  options_.merge.verify.step_m = kMapStep * 5.0;
  options_.merge.refine.step_m = kMapStep * 5.0;
  if (city_ != nullptr) {
    rulings_ = store::Rulings(city_.get());
    for (const store::NumberedMerge& merge : store::Merges(city_.get())) {
      if (merge.record.is_final) settled_ = {merge.record.drives.begin(), merge.record.drives.end()};
    }
    const auto fleet = link_.WithStore([](const FleetStore& known) { return known.Drives(); });
    Fill(fleet, &cache_);
    if (!fleet.drives.empty()) {
      fmt::print(stderr, "serve: {} drives in {}\n", fleet.drives.size(), options_.store.string());
    }
    for (const std::string& name : city_->damage()) {
      fmt::print(stderr, "serve: {} is damaged and left out; see 'mapweld fsck {}'\n", name, options_.store.string());
    }
  }
  std::signal(SIGINT, AskToStop);
  std::signal(SIGTERM, AskToStop);
}

void Server::Run() {
  while (g_stop == 0 && !AllEnded()) {
    link_.WaitForNews(requester_.busy() ? kBusyPause : kIdlePause);
    requester_.Step(Requester::Clock::now());
    ReportProgress();
    if (!IsDue()) continue;
    const double begin = Now();
    const Merged merged = MergeOnce(&cache_);
    merge_cost_s_ = Now() - begin;
    last_merge_s_ = Now();
    WantMissing(merged, cache_);
    SendBack(merged);
    Record(merged, false);
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
  Record(merged, true);
  if (link_.unsaved() > 0) throw std::runtime_error(link_.Warnings().back());
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
    const auto has_ended = [&](const DriveId& id) {
      return id.agent != 0 && store.IsComplete(id) && !settled_.contains(store.NameOf(id));
    };
    return std::count_if(ids.begin(), ids.end(), has_ended) >= options_.agents;
  });
}

Server::Merged Server::MergeOnce(merge::MergeCache* cache) {
  Merged merged;
  link_.WithStore([&](const FleetStore& store) {
    const FleetStore::Snapshot all = store.Drives();
    for (std::size_t d = 0; d < all.ids.size(); ++d) {
      if (store::IsQuarantined(rulings_, all.drives[d].name)) continue;
      merged.fleet.ids.push_back(all.ids[d]);
      merged.fleet.drives.push_back(all.drives[d]);
    }
    merged_keyframes_ = store.counters().keyframes;
    merged_submaps_ = store.counters().submaps;
  });
  StoredSubmaps submaps(&link_, &merged.fleet.ids);
  Silent silent;
  store::RefuseByHand(rulings_, merged.fleet.drives, cache);
  merged.result = merge::MergeDrives(merged.fleet.drives, submaps, options_.merge, &silent, cache);
  store::NameRefusals(rulings_, merged.fleet.drives, &merged.result);
  ++revision_;
  ++merges_;
  return merged;
}

void Server::WantMissing(const Merged& merged, const merge::MergeCache& cache) {
  StoredSubmaps submaps(&link_, &merged.fleet.ids);
  std::vector<Requester::Submap> wanted;
  for (const merge::SubmapKey& key : ByValue(merged.fleet.drives, merged.result, cache, &submaps)) {
    wanted.push_back({merged.fleet.ids[static_cast<std::size_t>(key.drive)], key.keyframe});
  }
  requester_.Want(std::move(wanted));
}

std::vector<store::DriveKey> Server::KeysOf(const FleetStore::Snapshot& fleet) {
  std::map<std::string, store::DriveKey> by_name;
  for (const store::StoredDrive& drive : city_->Drives()) by_name.emplace(drive.info.name, drive.key);
  std::vector<store::DriveKey> keys;
  for (const merge::Drive& drive : fleet.drives) keys.push_back(by_name[drive.name]);
  return keys;
}

// What an earlier run found between drives that have not grown since.
void Server::Fill(const FleetStore::Snapshot& fleet, merge::MergeCache* cache) {
  if (city_ == nullptr) return;
  StoredSubmaps submaps(&link_, &fleet.ids);
  store::PairMemory(city_.get(), &fleet.drives, KeysOf(fleet), &options_.merge).Fill(cache, &submaps);
}

void Server::Keep(const Merged& merged, const merge::MergeCache& cache) {
  if (city_ == nullptr) return;
  StoredSubmaps submaps(&link_, &merged.fleet.ids);
  try {
    store::PairMemory(city_.get(), &merged.fleet.drives, KeysOf(merged.fleet), &options_.merge).Keep(cache, &submaps);
  } catch (const store::StoreError& error) {
    fmt::print(stderr, "serve: the next run has to search all pairs of drives again: {}\n", error.what());
  }
}

// Every state whose groups are new, and the last one. The store may fail; the agents are told all the same.
void Server::Record(const Merged& merged, bool is_final) {
  if (city_ == nullptr) return;
  store::MergeRecord record =
      store::ToRecord(merged.fleet.drives, merged.result, is_final ? "serve, at its end" : "serve", store::TimeLabel());
  record.is_final = is_final;
  try {
    const auto last = store::LastMerge(city_.get());
    if (!is_final && store::Changes(last.has_value() ? &last->record : nullptr, record).empty()) return;
    store::RecordMerge(city_.get(), record);
  } catch (const store::StoreError& error) {
    fmt::print(stderr, "serve: the state of the merge is not recorded: {}\n", error.what());
  }
}

void Server::SendBack(const Merged& merged) {
  for (std::size_t d = 0; d < merged.fleet.ids.size(); ++d) {
    const int group = merged.result.group_of[d];
    if (!link_.IsHere(merged.fleet.ids[d])) continue;
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

// Merges once more, and searches every pair of drives in which something is new from nothing, fetching what the merge
// asks for, until it asks for nothing more: the result depends on what the agents drove, not on the order in which it
// came.
Server::Merged Server::MergeForGood() {
  for (;;) {
    const auto before = link_.WithStore([](const FleetStore& store) { return store.Drives(); });
    merge::MergeCache fresh;
    Fill(before, &fresh);
    Merged merged = MergeOnce(&fresh);
    WantMissing(merged, fresh);
    const std::size_t left = Fetch();
    if (left > 0) fmt::print(stderr, "serve: {} submaps did not arrive; merging without them\n", left);
    const bool more =
        link_.WithStore([&](const FleetStore& store) { return store.counters().submaps > merged_submaps_; });
    if (left == 0 && more) continue;
    Keep(merged, fresh);
    return merged;
  }
}

void Server::FetchMap(const Merged& merged) {
  std::vector<Requester::Submap> wanted;
  for (std::size_t d = 0; d < merged.fleet.ids.size(); ++d) {
    for (std::size_t k = 0; k < merged.fleet.drives[d].keyframes.size(); k += kMapStep) {
      wanted.push_back({merged.fleet.ids[d], static_cast<std::int32_t>(k)});
    }
  }
  requester_.Want(std::move(wanted));
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

// A line every two seconds, as long as something changes.
void Server::ReportProgress() {
  if (Now() - last_progress_s_ < 2.0) return;
  last_progress_s_ = Now();
  for (const std::string& warning : link_.Warnings()) {
    if (warned_.insert(warning).second) fmt::print(stderr, "serve: {}\n", warning);
  }
  std::string line;
  link_.WithStore([&](const FleetStore& store) {
    for (const DriveId& id : store.Ids()) {
      const auto health = store.Health(id);
      if (health.has_value()) line += fmt::format("  {} {:.0f} m", store.NameOf(id), health->path_m);
    }
    line += fmt::format("  | {} keyframes, {} submaps, merge {}", store.counters().keyframes, store.counters().submaps,
                        merges_);
  });
  if (line == last_progress_) return;
  last_progress_ = line;
  fmt::print(stderr, "serve:{}\n", line);
}

}  // namespace mapweld::serve
