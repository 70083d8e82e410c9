// SPDX-License-Identifier: Apache-2.0
// SOLiD: Kim, Choi, Sim, Kim, Cho, "Narrowing your FOV with SOLiD: Spatially Organized and Lightweight Global
// Descriptor for FOV-Constrained LiDAR Place Recognition", RA-L 2024. Points counted by range and elevation, elevations
// weighted by how full they are.
#pragma once

#include <cstddef>

#include "tools/describe/place_method.hpp"

namespace mapweld::baselines {

class Solid final : public describe::PlaceMethod {
 public:
  static constexpr std::size_t kRanges = 40;
  static constexpr std::size_t kAngles = 60;
  static constexpr std::size_t kElevations = 32;
  static constexpr float kNearest_m = 3;
  static constexpr float kReach_m = 50;          // of our submaps; the paper's scans reach 80
  static constexpr float kLowest_deg = -24.8F;   // the paper's range is the sensor's, here of the HDL-64E ...
  static constexpr float kHighest_deg = 38.4F;   // ... widened upwards, since a submap has no beams
  static constexpr std::size_t kMinPoints = 50;  // within these limits

  // Descriptor: R-SOLiD, 40 values. Signature: A-SOLiD, 60 values, which turn with the heading.
  Status Describe(const submap::Submap& submap, place::PlaceDescription* place) override;
  [[nodiscard]] Features Prepare(const place::PlaceDescription& place) const override;
  // One less the cosine of the R-SOLiDs.
  [[nodiscard]] float Distance(const Features& a, const Features& b) const override;
};

}  // namespace mapweld::baselines
