// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/prepared_cache.hpp"

#include <algorithm>

namespace mapweld::merge {

std::shared_ptr<const PreparedSubmap> PreparedCache::Get(SubmapKey key) {
  std::shared_ptr<Slot> slot;
  std::shared_ptr<const SubmapCloud> cloud;
  {
    const std::lock_guard lock(mutex_);
    const auto known = slots_.find(key);
    if (known != slots_.end() && known->second->ready) {
      known->second->last_use = ++uses_;
      return known->second->prepared;
    }
    cloud = source_->Find(key);
    if (cloud == nullptr) return nullptr;
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
    slot->prepared = std::make_shared<const PreparedSubmap>(*cloud);
    slot->ready = true;
  });
  return slot->prepared;
}

bool PreparedCache::Has(SubmapKey key) {
  const std::lock_guard lock(mutex_);
  return source_->Find(key) != nullptr;
}

}  // namespace mapweld::merge
