// SPDX-License-Identifier: Apache-2.0
// M2DP: He, Wang, Zhang, "M2DP: A Novel 3D Point Cloud Descriptor and its Application in Loop Closure Detection", IROS
// 2016. The cloud in its principal axes, projected onto 64 planes; the densities on them, as a matrix, by its first
// pair of singular vectors.
#pragma once

#include <cstddef>

#include "tools/describe/place_method.hpp"

namespace mapweld::baselines {

class M2dp final : public describe::PlaceMethod {
 public:
  static constexpr std::size_t kAzimuths = 4;     // p, of the planes
  static constexpr std::size_t kElevations = 16;  // q
  static constexpr std::size_t kCircles = 8;      // l, on each plane
  static constexpr std::size_t kSectors = 16;     // t
  static constexpr std::size_t kPlanes = kAzimuths * kElevations;
  static constexpr std::size_t kBins = kCircles * kSectors;
  static constexpr std::size_t kSize = kPlanes + kBins;
  static constexpr std::size_t kMinPoints = 50;

  // Descriptor: 192 values. No signature. 64 projections of every point.
  Status Describe(const submap::Submap& submap, place::PlaceDescription* place) override;
  [[nodiscard]] Features Prepare(const place::PlaceDescription& place) const override;
  // Half the squared Euclidean distance, which sorts like the paper's: both singular vectors have length 1.
  [[nodiscard]] float Distance(const Features& a, const Features& b) const override;
};

}  // namespace mapweld::baselines
