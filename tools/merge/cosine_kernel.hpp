// SPDX-License-Identifier: Apache-2.0
// Cosines between blocks of int8 descriptors: the innermost loop of the association. Every kernel gives the same bits;
// which one runs is chosen when the program starts, by what the processor can do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tools/merge/descriptor_set.hpp"

namespace mapweld::merge {

inline constexpr int kCosineUnit = 8192;  // a cosine of 1

// Keyframes begin..end-1 of a drive.
struct KeyframeRange {
  int begin = 0;
  int end = 0;
  [[nodiscard]] int size() const { return end - begin; }
};

// out[(i - rows.begin) * stride + (k - cols.begin)] = round(8192 * cosine of row i of a and row k of b), 0 where one
// has no description. The sum of products is exact; it is then scaled in single precision, first by a's norm.
using CosineFunction = void (*)(const DescriptorSet& a, KeyframeRange rows, const DescriptorSet& b, KeyframeRange cols,
                                std::int16_t* out, std::size_t stride);

struct CosineKernel {
  const char* name;
  CosineFunction compute;
};

// Those that this processor can run: the plain loop first, the fastest last.
std::span<const CosineKernel> CosineKernels();
inline const CosineKernel& FastestCosineKernel() {
  return CosineKernels().back();
}

namespace kernels {
void CosinesPortable(const DescriptorSet& a, KeyframeRange rows, const DescriptorSet& b, KeyframeRange cols,
                     std::int16_t* out, std::size_t stride);
// The others exist on x86-64 only, and need the instructions that they are named after.
void CosinesAvx2(const DescriptorSet& a, KeyframeRange rows, const DescriptorSet& b, KeyframeRange cols,
                 std::int16_t* out, std::size_t stride);
void CosinesVnni(const DescriptorSet& a, KeyframeRange rows, const DescriptorSet& b, KeyframeRange cols,
                 std::int16_t* out, std::size_t stride);
}  // namespace kernels

}  // namespace mapweld::merge
