// SPDX-License-Identifier: Apache-2.0
// The layers' inner loops for 64-bit ARM: for every processor, and for those with the dot product of ARMv8.2.
#pragma once

#include "core/nn/linear.hpp"
#include "core/nn/pack_rows.hpp"

namespace mapweld::nn {

void LinearNeon(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int8_t* out);
void LinearSumsNeon(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int32_t* out);
void LinearDotProduct(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int8_t* out);
void LinearSumsDotProduct(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int32_t* out);
void PackRowsNeon(const std::int8_t* rows, std::size_t count, std::size_t channels, std::int8_t* out);

}  // namespace mapweld::nn
