// SPDX-License-Identifier: Apache-2.0
#include "core/place/familiarity.hpp"

#include <algorithm>
#include <cmath>

namespace mapweld::place {

Status Familiarity::Open(const nn::ModelBlob& model) {
  const auto mean = model.Find<float>("familiar.mean", {kMeans});
  if (!mean.ok()) return mean.status();
  const auto whitening = model.Find<float>("familiar.whitening", {kMeans, kMeans});
  if (!whitening.ok()) return whitening.status();
  mean_ = mean.value();
  whitening_ = whitening.value();
  const auto finite = [](float v) { return std::isfinite(v); };
  const bool sane =
      std::all_of(mean_.begin(), mean_.end(), finite) && std::all_of(whitening_.begin(), whitening_.end(), finite);
  return sane ? Status::kOk : Status::kOutOfRange;
}

float Familiarity::Distance(const PlanImage& image) const {
  std::array<float, kMeans> off{};
  for (std::size_t band = 0; band < PlanImage::kBands; ++band) {
    for (std::size_t ring = 0; ring < PlanImage::kRings; ++ring) {
      int sum = 0;
      for (std::size_t d = 0; d < PlanImage::kDirections; ++d) sum += image.At(band, ring, d);
      const std::size_t i = band * PlanImage::kRings + ring;
      off[i] = static_cast<float>(sum) / (PlanImage::kMean * PlanImage::kDirections) - mean_[i];
    }
  }
  float squared = 0;
  for (std::size_t row = 0; row < kMeans; ++row) {
    float sum = 0;
    for (std::size_t i = 0; i < kMeans; ++i) sum += whitening_[row * kMeans + i] * off[i];
    squared += sum * sum;
  }
  return std::sqrt(squared);
}

}  // namespace mapweld::place
