// SPDX-License-Identifier: Apache-2.0
// Softmax in integers: which share of a row belongs to which cluster.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mapweld::nn {

inline constexpr std::size_t kMaxClusters = 64;
inline constexpr int kWholeShare = 127;  // what the shares of one row sum up to, but for their rounding

// How sums become logits in units of 1/256 of an octave (a logit of ln 2 is 256): floor(sum * multiplier / 2^shift +
// 1/2) per cluster, ranges as in LinearParameters. Padded to a multiple of 8.
struct LogitScale {
  std::span<const std::int32_t> multiplier;
  std::span<const std::int32_t> shift;
};

// sums: [count][stride of 8]; shares: [clusters][share_stride], so that shares[k * share_stride + m] is the share of
// row m in cluster k: e = Exp2Down(largest logit - logit), share = (e * floor(127 * 2^24 / sum of e) + 2^23) >> 24.
using SoftAssignFunction = void (*)(const LogitScale& scale, std::size_t clusters, const std::int32_t* sums,
                                    std::size_t count, std::int8_t* shares, std::size_t share_stride);
void SoftAssignPortable(const LogitScale& scale, std::size_t clusters, const std::int32_t* sums, std::size_t count,
                        std::int8_t* shares, std::size_t share_stride);

}  // namespace mapweld::nn
