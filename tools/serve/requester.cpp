// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/requester.hpp"

namespace mapweld::serve {
namespace {

constexpr std::size_t kKeyframesAtOnce = 32;
constexpr std::size_t kSubmapsAtOnce = 16;  // some 1.6 MB on their way per agent
constexpr auto kKeyframePause = std::chrono::milliseconds(300);
constexpr auto kSubmapPause = std::chrono::milliseconds(3000);

}  // namespace

bool Requester::IsDue(std::size_t missing, Clock::time_point now, Pace* pace) {
  const auto pause = missing == pace->missing ? kSubmapPause : kKeyframePause;
  if (missing == 0 || now - pace->last < pause) return false;
  *pace = {now, missing};
  return true;
}

void Requester::Step(Clock::time_point now) {
  const auto ids = link_->WithStore([](const FleetStore& store) { return store.Ids(); });
  for (const DriveId& id : ids) {
    const auto keyframes =
        link_->WithStore([&](const FleetStore& store) { return store.MissingKeyframes(id, kKeyframesAtOnce); });
    if (IsDue(keyframes.size(), now, &keyframe_pace_[id])) link_->RequestKeyframes(id, keyframes);
  }
  for (const auto& [id, wanted] : wanted_) {
    std::vector<std::int32_t> next;
    std::size_t missing = 0;
    link_->WithStore([&](const FleetStore& store) {
      for (const std::int32_t keyframe : wanted) {
        if (store.FindSubmap(id, keyframe) != nullptr) continue;
        ++missing;
        if (next.size() < kSubmapsAtOnce) next.push_back(keyframe);
      }
    });
    if (IsDue(missing, now, &submap_pace_[id])) link_->RequestSubmaps(id, next);
  }
}

std::size_t Requester::outstanding() {
  std::size_t missing = 0;
  for (const auto& [id, wanted] : wanted_) {
    link_->WithStore([&, &id = id, &wanted = wanted](const FleetStore& store) {
      for (const std::int32_t keyframe : wanted) missing += store.FindSubmap(id, keyframe) == nullptr ? 1U : 0U;
    });
  }
  return missing;
}

}  // namespace mapweld::serve
