// SPDX-License-Identifier: Apache-2.0
#include "tools/serve/serve_output.hpp"

namespace mapweld::serve {

std::shared_ptr<const merge::SubmapCloud> StoredSubmaps::Find(merge::SubmapKey key) {
  const merge::SubmapCloud* cloud = link_->WithStore([&](const FleetStore& store) {
    return store.FindSubmap((*ids_)[static_cast<std::size_t>(key.drive)], key.keyframe);
  });
  return cloud == nullptr ? nullptr : merge::Kept(cloud);
}

std::vector<report::DriveSummary> Traffic(FleetLink* link, const std::vector<DriveId>& ids) {
  std::vector<report::DriveSummary> traffic(ids.size());
  link->WithStore([&](const FleetStore& store) {
    for (std::size_t d = 0; d < ids.size(); ++d) {
      traffic[d].keyframe_bytes = static_cast<double>(store.KeyframeBytes(ids[d]));
      traffic[d].submap_bytes = static_cast<double>(store.SubmapBytes(ids[d]));
      const auto health = store.Health(ids[d]);
      if (!health.has_value()) continue;
      traffic[d].bytes_sent = static_cast<double>(health->bytes_sent);
      traffic[d].heap_calls = health->heap_calls;
    }
  });
  return traffic;
}

}  // namespace mapweld::serve
