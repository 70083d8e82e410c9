// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/presence.hpp"

#include <iterator>

namespace mapweld::serve {

void Presence::Heard(const DriveId& id, Clock::time_point now) {
  const auto [at, is_new] = heard_.try_emplace(id, Times{now, now});
  at->second.last = now;
  const auto later = std::next(at);
  if (later == heard_.end() || later->first.agent != id.agent) return;
  if (now - later->second.first > kOvertaking && now - later->second.last < kSilence) twins_.insert(id.agent);
}

bool Presence::IsHere(const DriveId& id, Clock::time_point now) const {
  const auto at = heard_.find(id);
  if (at == heard_.end() || now - at->second.last > kSilence) return false;
  const auto later = std::next(at);
  return later == heard_.end() || later->first.agent != id.agent || twins_.contains(id.agent);
}

}  // namespace mapweld::serve
