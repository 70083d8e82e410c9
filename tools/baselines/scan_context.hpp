// SPDX-License-Identifier: Apache-2.0
// Scan Context: Kim and Kim, "Scan Context: Egocentric Spatial Descriptor for Place Recognition Within 3D Point Cloud
// Map", IROS 2018. The plan view in 20 rings and 60 sectors, each cell with the height of its highest point.
#pragma once

#include <cstddef>

#include "tools/describe/place_method.hpp"

namespace mapweld::baselines {

class ScanContext final : public describe::PlaceMethod {
 public:
  static constexpr std::size_t kRings = 20;
  static constexpr std::size_t kSectors = 60;
  static constexpr float kReach_m = 50;         // of our submaps; the paper's scans reach 80
  static constexpr float kSensorHeight_m = 2;   // added to all heights, as in the paper's code
  static constexpr std::size_t kMinCells = 20;  // occupied; fewer is no place

  // The 1200 heights fill the descriptor and go on in the signature; both have one scale.
  Status Describe(const submap::Submap& submap, place::PlaceDescription* place) override;
  [[nodiscard]] Features Prepare(const place::PlaceDescription& place) const override;
  // The paper's column-wise cosine distance (its equation 6) at the best of all 60 turns (7), without its preselection
  // by ring keys: the recall is then the best that this descriptor can have. 72 000 multiply-adds.
  [[nodiscard]] float Distance(const Features& a, const Features& b) const override;
};

}  // namespace mapweld::baselines
