// SPDX-License-Identifier: Apache-2.0
#include "core/place/projection_spectrum.hpp"

#include <cmath>

#include "core/place/fft.hpp"
#include "core/place/trig_table.hpp"

namespace mapweld::place {
namespace {

// Full weight up to 15 m, none from 35 m on: a soft rim, so that what enters or leaves the view does so gradually.
constexpr std::int32_t kRimQ8 = 35 * kQ8;
constexpr std::int32_t kFadeQ8 = 20 * kQ8;

static_assert(kRimQ8 < 35 * kQ8 + 1, "projections reach 36 m");
constexpr auto kDirection = MakeDirectionTable<2 * ProjectionSpectrum::kDirections>();

// Worst case of one bin: the strip of 2 m that feeds it touches fewer than 800 cells, all of the heaviest weight.
static_assert(std::int64_t{800} * ColumnGrid::kMaxWeightQ8 * kQ8 < INT32_MAX);

std::int32_t FadedWeight(const Column& column) {
  const auto x = static_cast<float>(column.x_q8);
  const auto y = static_cast<float>(column.y_q8);
  const auto r = static_cast<std::int32_t>(std::sqrt(x * x + y * y));
  if (r >= kRimQ8) return 0;
  return r <= kRimQ8 - kFadeQ8 ? column.weight_q8 : column.weight_q8 * (kRimQ8 - r) / kFadeQ8;
}

float ThreeEighthsPowerOfRoot(float squared) {
  const float root16 = std::sqrt(std::sqrt(std::sqrt(std::sqrt(squared))));
  return root16 * root16 * root16;
}

}  // namespace

void ProjectionSpectrum::Compute(const ColumnGrid& grid) {
  for (auto& row : projection_q16_) row.fill(0);
  grid.ForEach([this](const Column& column) {
    const std::int32_t weight = FadedWeight(column);
    if (weight == 0) return;
    std::array<std::uint32_t, kDirections> along_q8;  // in a loop of its own, which the compiler turns into SIMD
    for (std::size_t d = 0; d < kDirections; ++d) {
      const std::int32_t along = (column.x_q8 * kDirection.x[d] + column.y_q8 * kDirection.y[d]) >> kDirectionShift;
      along_q8[d] = static_cast<std::uint32_t>(along + static_cast<std::int32_t>(kReach) * kQ8);
    }
    for (std::size_t d = 0; d < kDirections; ++d) {
      const std::size_t cell = along_q8[d] / kQ8;
      const auto fraction = static_cast<std::int32_t>(along_q8[d] % kQ8);
      projection_q16_[d][cell] += weight * (kQ8 - fraction);
      projection_q16_[d][cell + 1] += weight * fraction;
    }
  });

  std::array<Complex, kLength> line;
  std::array<float, kBins> raw{};
  for (std::size_t d = 0; d < kDirections; ++d) {
    line.fill({});
    for (std::size_t i = 0; i < 2 * kReach; ++i) line[i].re = static_cast<float>(projection_q16_[d][i]);
    Fft<kLength>(line);
    for (std::size_t f = 0; f < kBins; ++f) {
      raw[f] = ThreeEighthsPowerOfRoot(line[f].re * line[f].re + line[f].im * line[f].im);
    }
    amplitude_[d].fill(0);
    for (std::size_t f = 1; f + 1 < kBins; ++f) {
      amplitude_[d][f] = 0.25F * raw[f - 1] + 0.5F * raw[f] + 0.25F * raw[f + 1];
    }
  }
}

}  // namespace mapweld::place
