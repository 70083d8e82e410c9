// SPDX-License-Identifier: Apache-2.0
#include "core/nn/soft_assignment.hpp"

#include <algorithm>
#include <array>

#include "core/nn/exponential.hpp"
#include "core/nn/linear.hpp"

namespace mapweld::nn {

void SoftAssignPortable(const LogitScale& scale, std::size_t clusters, const std::int32_t* sums, std::size_t count,
                        std::int8_t* shares, std::size_t share_stride) {
  std::array<std::int32_t, kMaxClusters> e{};
  for (std::size_t m = 0; m < count; ++m, sums += SumStride(clusters)) {
    for (std::size_t k = 0; k < clusters; ++k) e[k] = ScaleSum(sums[k], scale.multiplier[k], scale.shift[k]);
    const std::int32_t largest = *std::max_element(e.begin(), e.begin() + static_cast<std::ptrdiff_t>(clusters));
    std::uint32_t total = 0;
    for (std::size_t k = 0; k < clusters; ++k) {
      e[k] = Exp2Down(largest - e[k]);
      total += static_cast<std::uint32_t>(e[k]);
    }
    const std::uint32_t factor = (std::uint32_t{kWholeShare} << 24U) / total;
    for (std::size_t k = 0; k < clusters; ++k) {
      shares[k * share_stride + m] =
          static_cast<std::int8_t>((static_cast<std::uint32_t>(e[k]) * factor + (1U << 23U)) >> 24U);
    }
  }
}

}  // namespace mapweld::nn
