// SPDX-License-Identifier: Apache-2.0
#include "core/nn/vnni.hpp"

#if defined(__x86_64__)
#define MAPWELD_TILE_TARGET "avx2,avx512f,avx512vl,avx512vnni"
#include "core/nn/linear_tiles_x86.hpp"
#include "core/nn/linear_vnni_dot.hpp"

namespace mapweld::nn {
namespace {

struct Instruction {
  MAPWELD_TILE_INLINE static __m256i Add(__m256i sum, __m256i x, __m256i w) { return _mm256_dpbusd_epi32(sum, x, w); }
};

}  // namespace

MAPWELD_TILE void LinearAvx512Vnni(const LinearLayer& layer, const std::int8_t* rows, std::size_t count,
                                   std::int8_t* out) {
  Walk<VnniDot<Instruction>>(layer, rows, count, StoreBytes(layer, out));
}
MAPWELD_TILE void LinearSumsAvx512Vnni(const LinearLayer& layer, const std::int8_t* rows, std::size_t count,
                                       std::int32_t* out) {
  Walk<VnniDot<Instruction>>(layer, rows, count, StoreSums(layer, out));
}

}  // namespace mapweld::nn
#endif
