// SPDX-License-Identifier: Apache-2.0
// The layers' inner loops for AVX2. Call them only where the processor has it.
#pragma once

#include "core/nn/linear.hpp"
#include "core/nn/pack_rows.hpp"
#include "core/nn/soft_assignment.hpp"

namespace mapweld::nn {

void LinearAvx2(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int8_t* out);
void LinearSumsAvx2(const LinearLayer& layer, const std::int8_t* rows, std::size_t count, std::int32_t* out);
void SoftAssignAvx2(const LogitScale& scale, std::size_t clusters, const std::int32_t* sums, std::size_t count,
                    std::int8_t* shares, std::size_t share_stride);
void PackRowsAvx2(const std::int8_t* rows, std::size_t count, std::size_t channels, std::int8_t* out);

}  // namespace mapweld::nn
