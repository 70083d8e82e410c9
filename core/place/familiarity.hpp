// SPDX-License-Identifier: Apache-2.0
// Does a place look like those that the network was trained on? Another sensor, a narrow room or too few points change
// how structure is spread over sizes and heights, long before anybody sees that places are no longer recognised.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/base/status.hpp"
#include "core/nn/model_blob.hpp"
#include "core/place/plan_image.hpp"

namespace mapweld::place {

class Familiarity {
 public:
  static constexpr std::size_t kMeans = PlanImage::kBands * PlanImage::kRings;

  // The statuses of ModelBlob. The model must outlive this.
  Status Open(const nn::ModelBlob& model);

  // How far the image's ring means lie from those of the training places: their Mahalanobis distance (Mahalanobis,
  // 1936) in parts of the one that 99 of 100 training views keep, disturbed ones among them. Above 1 the place is
  // unlike all training. Does not depend on the heading. 9300 multiply-adds.
  [[nodiscard]] float Distance(const PlanImage& image) const;

 private:
  std::span<const float> mean_;
  std::span<const float> whitening_;  // rows of a kMeans x kMeans matrix, divided by the limit
};

}  // namespace mapweld::place
