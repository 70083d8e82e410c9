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

// (re^2 + im^2)^(3/16), by square roots only because those round the same way everywhere.
float PressedAmplitude(float re, float im) {
  const float root16 = std::sqrt(std::sqrt(std::sqrt(std::sqrt(re * re + im * im))));
  return root16 * root16 * root16;
}

template <std::size_t N>
void Smooth(const std::array<float, N>& from, std::array<float, N>* to) {
  to->fill(0);
  for (std::size_t i = 1; i + 1 < N; ++i) (*to)[i] = 0.25F * from[i - 1] + 0.5F * from[i] + 0.25F * from[i + 1];
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

  // Two real projections share one complex transform, one as the real and one as the imaginary part.
  std::array<Complex, kLength> line;
  for (std::size_t d = 0; d < kDirections; d += 2) {
    line.fill({});
    for (std::size_t i = 0; i < 2 * kReach; ++i) {
      line[i] = {static_cast<float>(projection_q16_[d][i]), static_cast<float>(projection_q16_[d + 1][i])};
    }
    Fft<kLength>(line);
    std::array<float, kBins> first{};
    std::array<float, kBins> second{};
    for (std::size_t f = 0; f < kBins; ++f) {
      const Complex& plus = line[f];
      const Complex& minus = line[(kLength - f) % kLength];
      first[f] = PressedAmplitude(plus.re + minus.re, plus.im - minus.im);
      second[f] = PressedAmplitude(plus.im + minus.im, minus.re - plus.re);
    }
    Smooth(first, &amplitude_[d]);
    Smooth(second, &amplitude_[d + 1]);
  }
}

}  // namespace mapweld::place
