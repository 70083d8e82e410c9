// SPDX-License-Identifier: Apache-2.0
// The linear layer for x86-64 processors with a dot product of bytes, in its older (AVX-512) and its newer (VEX)
// coding. Call them only where the processor has it.
#pragma once

#include "core/nn/linear.hpp"

namespace mapweld::nn {

void LinearAvx512Vnni(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int8_t* out);
void LinearSumsAvx512Vnni(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int32_t* out);
void LinearAvxVnni(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int8_t* out);
void LinearSumsAvxVnni(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int32_t* out);

}  // namespace mapweld::nn
