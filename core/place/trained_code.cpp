// SPDX-License-Identifier: Apache-2.0
#include "core/place/trained_code.hpp"

#include <cmath>

#include "core/place/normalize.hpp"

namespace mapweld::place {

Status TrainedCode::Open(std::span<const std::uint8_t> model, const nn::Kernels& kernels) {
  for (const Status status :
       {model_.Open(model), spectrum_.Open(model_), network_.Open(model_, kernels), familiarity_.Open(model_)}) {
    if (status != Status::kOk) return status;
  }
  const auto share = model_.Find<float>("network.share", {1});
  if (!share.ok()) return share.status();
  network_share_ = share.value()[0];
  return network_share_ >= 0 && network_share_ <= 1 ? Status::kOk : Status::kOutOfRange;
}

void TrainedCode::Run(const PlanImage& image, std::span<float, kDescriptorDim> out) {
  features_.Fill(image);
  const auto spectrum = out.first<SpectrumCode::kOutputs>();
  const auto network = out.last<PlanNetwork::kOutputs>();
  spectrum_.Run(features_, spectrum);
  network_.Run(image, features_, network);
  ScaleToLength(spectrum, std::sqrt(1 - network_share_));
  ScaleToLength(network, std::sqrt(network_share_));
}

}  // namespace mapweld::place
