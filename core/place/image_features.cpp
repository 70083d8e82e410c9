// SPDX-License-Identifier: Apache-2.0
#include "core/place/image_features.hpp"

namespace mapweld::place {

void ImageFeatures::Fill(const PlanImage& image) {
  for (std::size_t ring = 0; ring < kRings; ring += 2) {
    std::array<Complex, kAngles> lines;
    for (std::size_t d = 0; d < kAngles; ++d) {
      lines[d] = {static_cast<float>(image.At(0, ring, d)) / PlanImage::kMean,
                  static_cast<float>(image.At(0, ring + 1, d)) / PlanImage::kMean};
    }
    AngularOrders(lines, &orders_[ring], &orders_[ring + 1]);
  }
  float* power = values_.data();
  for (const auto& ring : orders_) {
    for (const Complex& order : ring) *power++ = PressedPower(order);
  }
  float* re = power;
  float* im = power + kRelationSize;
  for (std::size_t ring = 0; ring + kRingLag < kRings; ++ring) {
    for (std::size_t k = 1; k <= kRelationOrders; ++k) {
      const Complex relation = PressedRelation(orders_[ring][k], orders_[ring + kRingLag][k]);
      *re++ = relation.re;
      *im++ = relation.im;
    }
  }
}

}  // namespace mapweld::place
