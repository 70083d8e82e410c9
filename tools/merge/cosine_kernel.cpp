// SPDX-License-Identifier: Apache-2.0
#include "tools/merge/cosine_kernel.hpp"

#include <cmath>
#include <vector>

namespace mapweld::merge {

namespace kernels {

void CosinesPortable(const DescriptorSet& a, KeyframeRange rows, const DescriptorSet& b, KeyframeRange cols,
                     std::int16_t* out, std::size_t stride) {
  for (int i = rows.begin; i < rows.end; ++i, out += stride) {
    for (int k = cols.begin; k < cols.end; ++k) {
      const std::int8_t* x = a.row(i);
      const std::int8_t* y = b.row(k);
      std::int32_t dot = 0;
      for (int d = 0; d < place::kDescriptorDim; ++d) dot += static_cast<std::int16_t>(x[d]) * y[d];
      const float scaled = static_cast<float>(dot) * a.inverse_norm[static_cast<std::size_t>(i)];
      const float cosine = scaled * b.inverse_norm[static_cast<std::size_t>(k)];
      out[k - cols.begin] = static_cast<std::int16_t>(std::lrint(cosine * static_cast<float>(kCosineUnit)));
    }
  }
}

}  // namespace kernels

std::span<const CosineKernel> CosineKernels() {
  static const std::vector<CosineKernel> kernels = [] {
    std::vector<CosineKernel> out{{"portable", kernels::CosinesPortable}};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) out.push_back({"avx2", kernels::CosinesAvx2});
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512vnni")) {
      out.push_back({"avx512-vnni", kernels::CosinesVnni});
    }
#endif
    return out;
  }();
  return kernels;
}

}  // namespace mapweld::merge
