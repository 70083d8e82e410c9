// SPDX-License-Identifier: Apache-2.0
#include "core/place/describer.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/assert.hpp"
#include "core/nn/kernels.hpp"
#include "core/place/handmade_code.hpp"
#include "core/place/normalize.hpp"

namespace mapweld::place {
namespace {

constexpr std::size_t kDirections = ProjectionSpectrum::kDirections;

// Wavelengths of 3.2 m to 9 m: short enough to be sharp, long enough to be seen from both directions of travel.
constexpr std::size_t kSignatureFirstBin = 14;
constexpr std::size_t kSignatureEndBin = 40;

// Mean amplitude per direction: a curve with its peaks across the walls and the kerbs.
void FillDirections(const ProjectionSpectrum& spectrum, std::span<float, kSectors> out) {
  std::array<float, kDirections> sum{};
  for (std::size_t d = 0; d < kDirections; ++d) {
    for (std::size_t f = kSignatureFirstBin; f < kSignatureEndBin; ++f) sum[d] += spectrum.At(d, f);
  }
  for (std::size_t i = 0; i < kSectors; ++i) {
    const std::size_t d = 2 * i;
    out[i] = 0.25F * sum[(d + kDirections - 1) % kDirections] + 0.5F * sum[d] + 0.25F * sum[d + 1];
  }
}

}  // namespace

Describer::Describer(Method method) : method_(method) {
  if (method_ == Method::kTrained) {
    const Status status = trained_.Open(CompiledModel(), nn::ChooseKernels(nn::DetectCpu()));
    MAPWELD_ASSERT(status == Status::kOk);
  }
}

Status Describer::Describe(const submap::Submap& submap, PlaceDescription* description) {
  const Status status = grid_.Build(submap.points.span(), kMinPoints);
  if (status != Status::kOk) return status;
  image_.Build(grid_);
  azimuth_.Clear();
  grid_.ForEach([this](const Column& column) { azimuth_.Add(column); });
  DescribePlace(&description->descriptor);
  DescribeOrientation(&description->orientation);
  return Status::kOk;
}

void Describer::DescribePlace(PlaceDescriptor* descriptor) {
  std::array<float, kDescriptorDim> values{};
  if (method_ == Method::kTrained) {
    trained_.Run(image_, values);
    unfamiliarity_ = trained_.familiarity().Distance(image_);
  } else {
    HandmadeCode(image_.AllStructure(), values);
  }
  descriptor->scale = QuantizeToInt8(values, &descriptor->q);
}

void Describer::DescribeOrientation(OrientationSignature* signature) const {
  std::array<float, kSignatureDim> values{};
  const std::span<float, kSignatureDim> all(values);
  const auto directions = all.subspan<0, kSectors>();
  const auto near = all.subspan<kSectors, kSectors>();
  const auto far = all.subspan<2 * kSectors, kSectors>();
  FillDirections(image_.AllStructure(), directions);
  const auto near_profile = azimuth_.Near();
  const auto far_profile = azimuth_.Far();
  std::copy(near_profile.begin(), near_profile.end(), near.begin());
  std::copy(far_profile.begin(), far_profile.end(), far.begin());
  for (const std::span<float> block : {std::span<float>(directions), std::span<float>(near), std::span<float>(far)}) {
    SubtractMean(block);
  }
  // Squared, these are the weights of the three in the correlation: the directions say the angle to a fraction of a
  // degree but not which way round, the sectors say which way round.
  ScaleToLength(directions, 1.0F);
  ScaleToLength(near, 0.7F);
  ScaleToLength(far, 0.7F);
  signature->scale = QuantizeToInt8(values, &signature->q);
}

}  // namespace mapweld::place
