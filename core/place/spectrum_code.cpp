// SPDX-License-Identifier: Apache-2.0
#include "core/place/spectrum_code.hpp"

#include <algorithm>
#include <cmath>

#include "core/place/normalize.hpp"

namespace mapweld::place {

Status SpectrumCode::Open(const nn::ModelBlob& model) {
  const auto index = model.Find<std::int32_t>("spectrum.index", {kOutputs});
  if (!index.ok()) return index.status();
  const auto gain = model.Find<float>("spectrum.gain", {kOutputs});
  if (!gain.ok()) return gain.status();
  index_ = index.value();
  gain_ = gain.value();
  const auto is_feature = [](std::int32_t i) { return i >= 0 && i < static_cast<std::int32_t>(ImageFeatures::kSize); };
  const auto is_gain = [](float v) { return std::isfinite(v); };
  const bool sane =
      std::all_of(index_.begin(), index_.end(), is_feature) && std::all_of(gain_.begin(), gain_.end(), is_gain);
  return sane ? Status::kOk : Status::kOutOfRange;
}

void SpectrumCode::Run(const ImageFeatures& features, std::span<float, kOutputs> out) {
  const std::span<float, ImageFeatures::kSize> all(scaled_);
  const auto power = all.first<ImageFeatures::kPowerSize>();
  for (std::size_t order = 0; order < ImageFeatures::kOrders; ++order) {
    const float weight = order == 0 ? 0.5F : 1.0F;
    float sum = 0;
    for (std::size_t ring = 0; ring < ImageFeatures::kRings; ++ring) sum += weight * features.Power(ring, order);
    const float off = 0.5F * sum / static_cast<float>(ImageFeatures::kRings);
    for (std::size_t ring = 0; ring < ImageFeatures::kRings; ++ring) {
      power[ring * ImageFeatures::kOrders + order] = weight * features.Power(ring, order) - off;
    }
  }
  ScaleToLength(power, 1);
  const auto relations = all.last<2 * ImageFeatures::kRelationSize>();
  std::copy(features.relations().begin(), features.relations().end(), relations.begin());
  ScaleToLength(relations, 1);
  for (std::size_t i = 0; i < kOutputs; ++i) out[i] = scaled_[static_cast<std::size_t>(index_[i])] * gain_[i];
  ScaleToLength(out, 1);
}

}  // namespace mapweld::place
