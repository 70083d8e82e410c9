// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/merge/drive.hpp"
#include "tools/report/summary.hpp"
#include "tools/serve/fleet_link.hpp"

namespace mapweld::serve {

// Every kMapStep-th submap of a drive makes the map: 20 m apart, with 50 m of radius. Others that happen to have been
// fetched do not count, so that the map does not depend on how the merge went.
inline constexpr int kMapStep = 4;

// The submaps of the drives of one snapshot, straight from the store, which only ever adds some.
class StoredSubmaps final : public merge::SubmapSource {
 public:
  StoredSubmaps(FleetLink* link, const std::vector<DriveId>* ids) : link_(link), ids_(ids) {}
  std::shared_ptr<const merge::SubmapCloud> Find(merge::SubmapKey key) override;

 private:
  FleetLink* link_;
  const std::vector<DriveId>* ids_;
};

// What each drive sent, and its heap calls.
std::vector<report::DriveSummary> Traffic(FleetLink* link, const std::vector<DriveId>& ids);

}  // namespace mapweld::serve
