// SPDX-License-Identifier: Apache-2.0
#include "core/place/plan_image.hpp"

#include <algorithm>
#include <cmath>

namespace mapweld::place {
namespace {

constexpr float kFirstBin = 4.0F;
constexpr float kBinStep = 1.4F;

}  // namespace

void PlanImage::Build(const ColumnGrid& grid) {
  for (ProjectionSpectrum& spectrum : spectra_) spectrum.Clear();
  grid.ForEach([this](const Column& column) {
    spectra_[0].Add(column, column.weight_q8);
    spectra_[1].Add(column, column.tall_q8);
    spectra_[2].Add(column, column.high_q8);
  });
  for (std::size_t b = 0; b < kBands; ++b) {
    spectra_[b].Transform();
    Resample(spectra_[b], &bands_[b]);
  }
  float squares = 0;
  for (const auto& ring : bands_[0]) {
    for (const float v : ring) squares += v * v;
  }
  const float factor = kMean / (std::sqrt(squares / (kRings * kDirections)) + 1e-9F);
  for (std::size_t b = 0; b < kBands; ++b) {
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      for (std::size_t d = 0; d < kDirections; ++d) {
        pixels_[b][ring][d] =
            static_cast<std::uint8_t>(std::min(std::floor(bands_[b][ring][d] * factor + 0.5F), 255.0F));
      }
    }
  }
}

// Linear between bins, [1 2 1] / 4 over the directions, every other one kept.
void PlanImage::Resample(const ProjectionSpectrum& spectrum, Band* band) {
  constexpr std::size_t kFine = ProjectionSpectrum::kDirections;
  static_assert(kFine == 2 * kDirections);
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    const float at = kFirstBin + kBinStep * static_cast<float>(ring);
    const auto bin = static_cast<std::size_t>(at);
    const float fraction = at - static_cast<float>(bin);
    std::array<float, kFine> line;
    for (std::size_t d = 0; d < kFine; ++d) {
      line[d] = spectrum.At(d, bin) * (1 - fraction) + spectrum.At(d, bin + 1) * fraction;
    }
    for (std::size_t d = 0; d < kDirections; ++d) {
      (*band)[ring][d] = 0.25F * line[(2 * d + kFine - 1) % kFine] + 0.5F * line[2 * d] + 0.25F * line[2 * d + 1];
    }
  }
}

}  // namespace mapweld::place
