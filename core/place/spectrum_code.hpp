// SPDX-License-Identifier: Apache-2.0
// The image's features with trained weights: which of them tell places apart, and how well. Power and relations are
// each scaled to length 1 first; what the orders have in common over the rings is halved, as in the hand-made
// descriptor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/nn/model_blob.hpp"
#include "core/place/image_features.hpp"

namespace mapweld::place {

class SpectrumCode {
 public:
  static constexpr std::size_t kOutputs = 768;

  // The model must outlive this. kVersion, kEmpty: it is of another network; kOutOfRange: its numbers make no sense.
  Status Open(const nn::ModelBlob& model);

  // out: unit length.
  void Run(const ImageFeatures& features, std::span<float, kOutputs> out);

 private:
  std::span<const std::int32_t> index_;  // into ImageFeatures, of each output
  std::span<const float> gain_;
  std::array<float, ImageFeatures::kSize> scaled_;
};

}  // namespace mapweld::place
