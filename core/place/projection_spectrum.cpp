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

// Worst case: the strip of 1 m that falls into one cell touches fewer than 500 columns, all of the heaviest weight.
static_assert(std::int64_t{500} * ColumnGrid::kMaxWeightQ8 * kQ8 < INT32_MAX);

std::int32_t FadedWeight(const Column& column, std::int32_t weight_q8) {
  const std::int32_t inside = kRimQ8 - column.range_q8;
  if (inside <= 0) return 0;
  return inside >= kFadeQ8 ? weight_q8 : weight_q8 * inside / kFadeQ8;
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

// The projection with linear sharing between cells: 256 times the weight, less what belongs to the next cell.
template <std::size_t N, class Slot>
void Unpack(const std::array<std::uint64_t, N>& packed, Slot slot) {
  std::int64_t from_before = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const auto weight = static_cast<std::int64_t>(packed[i] >> 32U);
    const auto to_next = static_cast<std::int64_t>(packed[i] & 0xFFFFFFFFU);
    slot(i) = static_cast<float>(weight * kQ8 - to_next + from_before);
    from_before = to_next;
  }
}

}  // namespace

void ProjectionSpectrum::Clear() {
  for (auto& row : packed_) row.fill(0);
}

void ProjectionSpectrum::Add(const Column& column, std::int32_t weight_q8) {
  const auto weight = static_cast<std::uint64_t>(FadedWeight(column, weight_q8));
  if (weight == 0) return;
  std::array<std::uint32_t, kDirections> along_q8;  // in a loop of its own, which the compiler turns into SIMD
  for (std::size_t d = 0; d < kDirections; ++d) {
    const std::int32_t along = (column.x_q8 * kDirection.x[d] + column.y_q8 * kDirection.y[d]) >> kDirectionShift;
    along_q8[d] = static_cast<std::uint32_t>(along + static_cast<std::int32_t>(kReach) * kQ8);
  }
  for (std::size_t d = 0; d < kDirections; ++d) {
    packed_[d][along_q8[d] / kQ8] += (weight << 32U) + weight * (along_q8[d] % kQ8);
  }
}

void ProjectionSpectrum::Transform() {
  // Two real projections share one complex transform, one as the real and one as the imaginary part.
  std::array<Complex, kLength> line;
  for (std::size_t d = 0; d < kDirections; d += 2) {
    line.fill({});
    Unpack(packed_[d], [&line](std::size_t i) -> float& { return line[i].re; });
    Unpack(packed_[d + 1], [&line](std::size_t i) -> float& { return line[i].im; });
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
