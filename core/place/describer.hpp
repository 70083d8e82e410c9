// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/base/status.hpp"
#include "core/place/azimuth_profile.hpp"
#include "core/place/column_grid.hpp"
#include "core/place/descriptor.hpp"
#include "core/place/plan_image.hpp"
#include "core/place/trained_code.hpp"
#include "core/submap/submap.hpp"

namespace mapweld::place {

// Submap in, place description out. Owns its scratch memory (about 1.8 MB: keep it in static memory); no heap. The same
// set of points gives the same bytes, in whatever order they come and on whatever machine.
//
// Cost: two passes over the points, 384 integer multiply-adds per occupied 0.5 m cell within 35 m, 192 transforms of
// length 128, and the network's 11 million multiply-adds; docs/descriptor.md has the measured times.
class Describer {
 public:
  enum class Method {
    kHandmade,  // without training
    kTrained,   // weights of the compiled model; docs/descriptor.md says where it is better and where not yet
  };
  static constexpr std::size_t kMinPoints = 200;

  explicit Describer(Method method = Method::kHandmade);

  // kBadInput, with *description untouched: fewer than kMinPoints points within reach, points that are not finite or
  // beyond 1 km, or points that all lie in one plane or line. A description that looks valid is never made up.
  Status Describe(const submap::Submap& submap, PlaceDescription* description);

  // Of the last submap that was described: above 1 it looks unlike the places that the network was trained on
  // (familiarity.hpp), and the description deserves less trust. 0 for what was not trained.
  [[nodiscard]] float unfamiliarity() const { return unfamiliarity_; }

 private:
  void DescribePlace(PlaceDescriptor* descriptor);
  void DescribeOrientation(OrientationSignature* signature) const;

  Method method_;
  ColumnGrid grid_;
  PlanImage image_;
  AzimuthProfile azimuth_;
  TrainedCode trained_;
  float unfamiliarity_ = 0;
};

}  // namespace mapweld::place
