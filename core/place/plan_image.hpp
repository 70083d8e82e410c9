// SPDX-License-Identifier: Apache-2.0
// What the network looks at: the amplitude spectra of the plan view, taken at three heights, on a polar grid of
// frequencies. A step aside changes them little, a turn shifts them along the direction axis.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/place/column_grid.hpp"
#include "core/place/projection_spectrum.hpp"

namespace mapweld::place {

class PlanImage {
 public:
  static constexpr std::size_t kBands = 3;        // all structure, that above 1 m, that above 3 m
  static constexpr std::size_t kRings = 32;       // frequencies (4 + 1.4 ring) / 128 per metre: 32 m to 2.7 m
  static constexpr std::size_t kDirections = 64;  // over half a turn; the image repeats after it
  static constexpr float kMean = 64;              // root mean square of the first band

  // Three passes over the occupied columns of `grid`. About 450 kB of working memory inside.
  void Build(const ColumnGrid& grid);

  [[nodiscard]] std::uint8_t At(std::size_t band, std::size_t ring, std::size_t direction) const {
    return pixels_[band][ring][direction];
  }

  // The spectrum that the first band was sampled from.
  [[nodiscard]] const ProjectionSpectrum& AllStructure() const { return spectra_[0]; }

 private:
  using Band = std::array<std::array<float, kDirections>, kRings>;
  static void Resample(const ProjectionSpectrum& spectrum, Band* band);

  std::array<ProjectionSpectrum, kBands> spectra_;
  std::array<Band, kBands> bands_;
  std::array<std::array<std::array<std::uint8_t, kDirections>, kRings>, kBands> pixels_;
};

}  // namespace mapweld::place
