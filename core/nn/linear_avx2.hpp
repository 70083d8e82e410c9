// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/nn/linear.hpp"

namespace mapweld::nn {

// AVX2: byte products added in pairs (maddubs), 16-bit sums in pairs (madd). Call only where the processor has it.
void LinearAvx2(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int8_t* out);
void LinearSumsAvx2(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int32_t* out);

}  // namespace mapweld::nn
