// SPDX-License-Identifier: Apache-2.0
// The two attentions of AutoMerge (Yin et al., T-RO 2023) on a vector of C channels.
#pragma once

#include <cstdint>
#include <span>

#include "core/nn/kernels.hpp"
#include "core/nn/linear.hpp"

namespace mapweld::nn {

// Eq. 1: out = v + gamma SoftMax(v v^T)^T v, the softmax along each row. The C x C matrix is never stored: row i adds
// v_i softmax(v_i v) to the result. row: C numbers of working memory. C * C exponentials. Every value in exponent.hpp's
// sense the same bits everywhere; C is a multiple of 8. out must not be v.
void SelfAttention(std::span<const float> v, float gamma, std::span<float> row, std::span<float> out);

// Eqs. 4 and 5 with the layer that the trainer chose for alpha_corr (eqs. 2 and 3 come down to v times a number):
// out[c] = (v[c] * Sigmoid(layer(v)[c]) + 64) >> 7. layer: C -> C, lowest -127, its output in 1/16. gate: RowStride(C)
// bytes of working memory. out may be v.
void Gate(const Kernels& kernels, const LinearLayer& layer, const std::int8_t* v, std::int8_t* gate, std::int8_t* out);

}  // namespace mapweld::nn
