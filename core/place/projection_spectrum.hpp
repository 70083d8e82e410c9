// SPDX-License-Identifier: Apache-2.0
// The 2-D amplitude spectrum of a plan view, sampled on a polar grid of frequencies. Moving the view only turns phases,
// so amplitudes stay; turning it shifts them along the direction axis. No Cartesian image in between that would prefer
// some headings: the view is projected onto 128 directions and each projection transformed (projection-slice theorem:
// Bracewell, "Strip integration in radio astronomy", Aust. J. Phys. 9, 1956; used for place recognition by Lu et al.,
// "One RING to Rule Them All", ICRA 2022, with other features).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/place/column_grid.hpp"

namespace mapweld::place {

class ProjectionSpectrum {
 public:
  static constexpr std::size_t kDirections = 128;  // over half a turn; the spectrum repeats after it
  static constexpr std::size_t kBins = 64;         // bin f: f / 128 cycles per metre

  // Clear, then Add every column of a view, then Transform. The order of the columns does not matter.
  void Clear();
  // weight_q8: of the column, or of a part of it; at most ColumnGrid::kMaxWeightQ8. 128 integer multiply-adds if within
  // 35 m.
  void Add(const Column& column, std::int32_t weight_q8);
  void Transform();  // 64 transforms of length 128: about 0.2 ms

  // |F|^(3/8) at direction pi d / 128 and bin f, smoothed over neighbouring bins. f in 0..kBins - 2. The small exponent
  // keeps the few strong lines of a straight street from drowning the rest.
  [[nodiscard]] float At(std::size_t direction, std::size_t bin) const { return amplitude_[direction][bin]; }

 private:
  static constexpr std::size_t kLength = 128;  // 1 m cells along each projection
  static constexpr std::size_t kReach = 36;    // of them, on either side of the origin, can be hit
  // Per cell the sum of the weights (upper half) and the sum of weight times place inside the cell (lower half): one
  // addition shares a column between two neighbouring cells.
  std::array<std::array<std::uint64_t, 2 * kReach>, kDirections> packed_;
  std::array<std::array<float, kBins>, kDirections> amplitude_;
};

}  // namespace mapweld::place
