// SPDX-License-Identifier: Apache-2.0
// What of the polar image's first band does not change when the vehicle turns: the power of every ring at angular
// orders 0..17, and the relation of rings 4 apart at orders 1..8.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/place/angular_features.hpp"
#include "core/place/plan_image.hpp"

namespace mapweld::place {

class ImageFeatures {
 public:
  static constexpr std::size_t kRings = PlanImage::kRings;
  static constexpr std::size_t kOrders = 18;
  static constexpr std::size_t kRelationOrders = 8;
  static constexpr std::size_t kRingLag = 4;
  static constexpr std::size_t kPowerSize = kRings * kOrders;
  static constexpr std::size_t kRelationSize = (kRings - kRingLag) * kRelationOrders;
  static constexpr std::size_t kSize = kPowerSize + 2 * kRelationSize;

  // 16 transforms of length 64.
  void Fill(const PlanImage& image);

  [[nodiscard]] std::span<const float, kSize> all() const { return values_; }
  [[nodiscard]] float Power(std::size_t ring, std::size_t order) const { return values_[ring * kOrders + order]; }
  // All real parts, then all imaginary parts.
  [[nodiscard]] std::span<const float, 2 * kRelationSize> relations() const {
    return std::span<const float, kSize>(values_).last<2 * kRelationSize>();
  }

 private:
  static_assert(PlanImage::kDirections == kAngles);
  std::array<std::array<Complex, kOrders>, kRings> orders_;
  std::array<float, kSize> values_;
};

}  // namespace mapweld::place
