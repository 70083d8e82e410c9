// SPDX-License-Identifier: Apache-2.0
#include "core/place/describer.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/place/fft.hpp"
#include "core/place/normalize.hpp"

namespace mapweld::place {
namespace {

constexpr std::size_t kDirections = ProjectionSpectrum::kDirections;
constexpr std::size_t kRings = 32;          // frequencies of the plan view taken into the descriptor
constexpr float kFirstBin = 4.0F;           // wavelengths from 32 m ...
constexpr float kBinStep = 1.4F;            // ... down to 2.7 m
constexpr std::size_t kPowerOrders = 18;    // angular orders 0..17 whose amplitudes are kept, per ring
constexpr std::size_t kRelationOrders = 8;  // angular orders 1..8 whose phase between two rings is kept
constexpr std::size_t kRelationLag = 4;     // rings apart
constexpr std::size_t kRelations = kRings - kRelationLag;
constexpr std::size_t kPowerSize = kRings * kPowerOrders;
constexpr std::size_t kRelationSize = kRelations * kRelationOrders;
static_assert(kPowerSize + 2 * kRelationSize == kDescriptorDim);

constexpr float kMeanShare = 0.5F;       // of the mean over the rings that is taken off each angular order
constexpr float kRelationLength = 0.3F;  // length of the relation block beside the power block's 1

// Angular transform of each ring: a turn of the view multiplies order k of every ring by the same phase.
using AngularSpectrum = std::array<std::array<Complex, kPowerOrders>, kRings>;

void TransformRings(const ProjectionSpectrum& spectrum, AngularSpectrum* angular) {
  std::array<Complex, kDirections> line;
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    const float at = kFirstBin + kBinStep * static_cast<float>(ring);
    const auto bin = static_cast<std::size_t>(at);
    const float fraction = at - static_cast<float>(bin);
    for (std::size_t d = 0; d < kDirections; ++d) {
      line[d] = {spectrum.At(d, bin) * (1 - fraction) + spectrum.At(d, bin + 1) * fraction, 0};
    }
    Fft<kDirections>(line);
    for (std::size_t k = 0; k < kPowerOrders; ++k) (*angular)[ring][k] = line[k];
  }
}

float SquaredNorm(const Complex& c) {
  return c.re * c.re + c.im * c.im;
}

// |c|^(3/4), by square roots only because those round the same way everywhere.
float ThreeQuarterPower(const Complex& c) {
  const float root8 = std::sqrt(std::sqrt(std::sqrt(SquaredNorm(c))));
  return root8 * root8 * root8;
}

// The power of each order in each ring does not change with the heading. The orders share a common trend over the
// rings, the same for every place; half of its mean is taken off so that places differ more.
void FillPower(const AngularSpectrum& angular, std::span<float, kPowerSize> out) {
  for (std::size_t k = 0; k < kPowerOrders; ++k) {
    const float weight = k == 0 ? 0.5F : 1.0F;
    float sum = 0;
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      const float power = weight * ThreeQuarterPower(angular[ring][k]);
      out[ring * kPowerOrders + k] = power;
      sum += power;
    }
    const float off = kMeanShare * sum / static_cast<float>(kRings);
    for (std::size_t ring = 0; ring < kRings; ++ring) out[ring * kPowerOrders + k] -= off;
  }
}

// F_r(k) conj(F_{r+4}(k)): the phase that a turn adds cancels, what stays is how the two rings are turned against each
// other. The power alone forgets that. The amplitude is pressed to its fourth root.
void FillRelations(const AngularSpectrum& angular, std::span<float, 2 * kRelationSize> out) {
  for (std::size_t ring = 0; ring < kRelations; ++ring) {
    for (std::size_t order = 0; order < kRelationOrders; ++order) {
      const Complex& a = angular[ring][order + 1];
      const Complex& b = angular[ring + kRelationLag][order + 1];
      const Complex product{a.re * b.re + a.im * b.im, a.im * b.re - a.re * b.im};
      const float pressed = ThreeQuarterPower(product);
      const std::size_t i = ring * kRelationOrders + order;
      out[i] = pressed > 0 ? product.re / pressed : 0;
      out[kRelationSize + i] = pressed > 0 ? product.im / pressed : 0;
    }
  }
}

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

Status Describer::Describe(const submap::Submap& submap, PlaceDescription* description) {
  const Status status = grid_.Build(submap.points.span(), kMinPoints);
  if (status != Status::kOk) return status;
  spectrum_.Clear();
  azimuth_.Clear();
  grid_.ForEach([this](const Column& column) {
    spectrum_.Add(column, column.weight_q8);
    azimuth_.Add(column);
  });
  spectrum_.Transform();
  DescribePlace(&description->descriptor);
  DescribeOrientation(&description->orientation);
  return Status::kOk;
}

void Describer::DescribePlace(PlaceDescriptor* descriptor) const {
  AngularSpectrum angular;
  TransformRings(spectrum_, &angular);
  std::array<float, kDescriptorDim> values{};
  const std::span<float, kDescriptorDim> all(values);
  FillPower(angular, all.first<kPowerSize>());
  ScaleToLength(all.first<kPowerSize>(), 1);
  FillRelations(angular, all.last<2 * kRelationSize>());
  ScaleToLength(all.last<2 * kRelationSize>(), kRelationLength);
  ScaleToLength(all, 1);
  descriptor->scale = QuantizeToInt8(values, &descriptor->q);
}

void Describer::DescribeOrientation(OrientationSignature* signature) const {
  std::array<float, kSignatureDim> values{};
  const std::span<float, kSignatureDim> all(values);
  const auto directions = all.subspan<0, kSectors>();
  const auto near = all.subspan<kSectors, kSectors>();
  const auto far = all.subspan<2 * kSectors, kSectors>();
  FillDirections(spectrum_, directions);
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
