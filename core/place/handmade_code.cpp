// SPDX-License-Identifier: Apache-2.0
#include "core/place/handmade_code.hpp"

#include <array>
#include <cmath>

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

}  // namespace

void HandmadeCode(const ProjectionSpectrum& spectrum, std::span<float, kDescriptorDim> out) {
  AngularSpectrum angular;
  TransformRings(spectrum, &angular);
  FillPower(angular, out.first<kPowerSize>());
  ScaleToLength(out.first<kPowerSize>(), 1);
  FillRelations(angular, out.last<2 * kRelationSize>());
  ScaleToLength(out.last<2 * kRelationSize>(), kRelationLength);
  ScaleToLength(out, 1);
}

}  // namespace mapweld::place
