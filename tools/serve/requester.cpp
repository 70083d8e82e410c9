// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/requester.hpp"

#include <algorithm>

namespace mapweld::serve {
namespace {

constexpr std::size_t kKeyframesAtOnce = 32;
constexpr std::size_t kSubmapsAtOnce = 16;  // some 1.6 MB on their way per agent
constexpr auto kKeyframePause = std::chrono::milliseconds(300);
constexpr auto kSubmapPause = std::chrono::milliseconds(3000);
constexpr double kSubmapBytes = 60e3;  // of one on the wire, about

}  // namespace

bool Requester::IsDue(std::size_t missing, Clock::time_point now, const Pace& pace) {
  return missing > 0 && now - pace.last >= (missing == pace.missing ? kSubmapPause : kKeyframePause);
}

void Requester::Step(Clock::time_point now) {
  busy_ = false;
  RequestKeyframes(now);
  RequestSubmaps(now);
  last_step_ = now;
}

void Requester::RequestKeyframes(Clock::time_point now) {
  const auto ids = link_->WithStore([](const FleetStore& store) { return store.Ids(); });
  for (const DriveId& id : ids) {
    const auto keyframes =
        link_->WithStore([&](const FleetStore& store) { return store.MissingKeyframes(id, kKeyframesAtOnce); });
    if (keyframes.empty() || !link_->IsHere(id)) continue;
    busy_ = true;
    Pace& pace = keyframe_pace_[id];
    if (!IsDue(keyframes.size(), now, pace)) continue;
    pace = {now, keyframes.size()};
    link_->RequestKeyframes(id, keyframes);
  }
}

// Goes down the list from the most valuable one. An agent that was asked a moment ago is left to answer.
void Requester::RequestSubmaps(Clock::time_point now) {
  std::vector<Submap> missing;
  link_->WithStore([&](const FleetStore& store) {
    for (const Submap& submap : wanted_) {
      if (store.FindSubmap(submap.id, submap.keyframe) == nullptr) missing.push_back(submap);
    }
  });
  std::map<DriveId, std::size_t> missing_of;
  for (const Submap& submap : missing) ++missing_of[submap.id];
  const double elapsed_s = std::chrono::duration<double>(now - last_step_).count();
  // No more than one second's worth is saved up, but always enough for one submap.
  allowance_ = std::min(allowance_ + bytes_per_s_ * elapsed_s, std::max(bytes_per_s_, kSubmapBytes));
  std::map<DriveId, std::vector<std::int32_t>> ask;
  for (const auto& [id, count] : missing_of) {
    if (!link_->IsHere(id)) continue;
    busy_ = true;
    if (IsDue(count, now, submap_pace_[id])) ask[id] = {};
  }
  for (const Submap& submap : missing) {
    const auto at = ask.find(submap.id);
    if (at == ask.end() || at->second.size() >= kSubmapsAtOnce) continue;
    if (bytes_per_s_ > 0) {
      if (allowance_ < kSubmapBytes) break;
      allowance_ -= kSubmapBytes;
    }
    at->second.push_back(submap.keyframe);
  }
  for (const auto& [id, keyframes] : ask) {
    if (keyframes.empty()) continue;
    submap_pace_[id] = {now, missing_of[id]};
    link_->RequestSubmaps(id, keyframes);
  }
}

std::size_t Requester::outstanding() {
  std::map<DriveId, std::size_t> missing_of;
  link_->WithStore([&](const FleetStore& store) {
    for (const Submap& submap : wanted_) {
      if (store.FindSubmap(submap.id, submap.keyframe) == nullptr) ++missing_of[submap.id];
    }
  });
  std::size_t missing = 0;
  for (const auto& [id, count] : missing_of) missing += link_->IsHere(id) ? count : 0;
  return missing;
}

}  // namespace mapweld::serve
