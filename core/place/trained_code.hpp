// SPDX-License-Identifier: Apache-2.0
// The trained place descriptor: the weighted spectrum and the network's code side by side.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/place/descriptor.hpp"
#include "core/place/familiarity.hpp"
#include "core/place/image_features.hpp"
#include "core/place/plan_image.hpp"
#include "core/place/plan_network.hpp"
#include "core/place/spectrum_code.hpp"

namespace mapweld::place {

// The model compiled into the program (core/place/model).
std::span<const std::uint8_t> CompiledModel();

class TrainedCode {
 public:
  // The statuses of ModelBlob, SpectrumCode, PlanNetwork and Familiarity. The bytes must outlive this and lie at a
  // multiple of 64.
  Status Open(std::span<const std::uint8_t> model, const nn::Kernels& kernels);

  // out: unit length.
  void Run(const PlanImage& image, std::span<float, kDescriptorDim> out);

  [[nodiscard]] const Familiarity& familiarity() const { return familiarity_; }

 private:
  static_assert(SpectrumCode::kOutputs + PlanNetwork::kOutputs == kDescriptorDim);

  nn::ModelBlob model_;
  float network_share_ = 0;  // of the squared length
  ImageFeatures features_;
  SpectrumCode spectrum_;
  PlanNetwork network_;
  Familiarity familiarity_;
};

}  // namespace mapweld::place
