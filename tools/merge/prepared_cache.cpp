// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/prepared_cache.hpp"

#include <algorithm>

namespace mapweld::merge {

std::shared_ptr<const PreparedSubmap> PreparedCache::Get(SubmapKey key) {
  std::shared_ptr<Slot> slot;
  {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<Slot>& at = slots_[key];
    if (at == nullptr) at = std::make_shared<Slot>();
    at->last_use = ++uses_;
    slot = at;
    if (slots_.size() > capacity_) {
      slots_.erase(std::min_element(slots_.begin(), slots_.end(), [](const auto& x, const auto& y) {
        return x.second->last_use < y.second->last_use;
      }));
    }
  }
  std::call_once(slot->once, [&] {
    const std::shared_ptr<const SubmapCloud> cloud = source_->Find(key);
    if (cloud != nullptr) slot->prepared = std::make_shared<const PreparedSubmap>(*cloud);
  });
  return slot->prepared;
}

bool PreparedCache::Has(SubmapKey key) {
  return source_->Has(key);
}

}  // namespace mapweld::merge
