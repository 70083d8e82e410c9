// SPDX-License-Identifier: Apache-2.0
#include "core/nn/net_vlad.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/base/assert.hpp"

namespace mapweld::nn {
namespace {

bool LogitInRange(const LogitScale& logit) {
  for (std::size_t i = 0; i < logit.multiplier.size(); ++i) {
    if (logit.multiplier[i] < (1 << 30) || logit.shift[i] < 32 || logit.shift[i] > 62) return false;
  }
  return true;
}

std::int8_t ToInt8(float value) {
  return static_cast<std::int8_t>(std::clamp(std::floor(value + 0.5F), -127.0F, 127.0F));
}

}  // namespace

Result<NetVladLayer> MakeNetVlad(const NetVladParameters& parameters) {
  const NetVladParameters& p = parameters;
  const Result<LinearLayer> assign = MakeLinear(p.assign);
  if (!assign.ok()) return assign.status();
  const std::size_t padded = SumStride(p.assign.outputs);
  if (p.assign.outputs > kMaxClusters || !p.assign.multiplier.empty()) return Status::kBadInput;
  if (p.logit.multiplier.size() != padded || p.logit.shift.size() != padded) return Status::kBadInput;
  if (p.centres.size() != p.assign.outputs * p.assign.inputs) return Status::kBadInput;
  const bool finite = std::all_of(p.centres.begin(), p.centres.end(), [](float c) { return std::abs(c) <= 1e6F; });
  if (!finite || !LogitInRange(p.logit) || !(p.output_scale > 0 && p.output_scale <= 1e6F)) return Status::kOutOfRange;
  return NetVladLayer{assign.value(), p.logit, p.centres, p.output_scale};
}

NetVlad::NetVlad(const NetVladLayer& layer, const Kernels& kernels, std::span<std::int32_t> memory)
    : layer_(layer), kernels_(kernels) {
  MAPWELD_ASSERT(memory.size() >= Words(layer.channels(), layer.clusters()));
  const auto take = [&](std::size_t words) {
    const auto part = memory.first(words);
    memory = memory.subspan(words);
    return part;
  };
  sums_ = take(layer.clusters() * SumStride(layer.channels()));
  block_sums_ = take(sums_.size());
  no_bias_ = take(SumStride(layer.channels()));
  share_sums_ = take(SumStride(layer.clusters()));
  assign_sums_ = take(kBlockRows * SumStride(layer.clusters()));
  packed_ = reinterpret_cast<std::int8_t*>(take(PackedRowsBytes(layer.channels()) / 4).data());
  shares_ = reinterpret_cast<std::int8_t*>(memory.data());
  Begin();
}

void NetVlad::Begin() {
  std::fill(sums_.begin(), sums_.end(), 0);
  std::fill(no_bias_.begin(), no_bias_.end(), 0);
  std::fill(share_sums_.begin(), share_sums_.end(), 0);
  rows_ = 0;
}

Status NetVlad::AddBlock(const std::int8_t* rows, std::size_t count) {
  MAPWELD_ASSERT(count <= kBlockRows);
  if (rows_ + count > kMaxRows) return Status::kFull;
  if (count == 0) return Status::kOk;
  rows_ += count;
  const std::size_t clusters = layer_.clusters();
  // Shares of rows that are not there are 0, so that what stands in their place does not count.
  if (count < kBlockRows) std::memset(shares_, 0, clusters * kBlockRows);
  kernels_.linear_sums(layer_.assign, rows, count, assign_sums_.data());
  kernels_.soft_assign(layer_.logit, clusters, assign_sums_.data(), count, shares_, kBlockRows);
  for (std::size_t k = 0; k < clusters; ++k) {
    std::int32_t sum = 0;
    for (std::size_t m = 0; m < kBlockRows; ++m) sum += shares_[k * kBlockRows + m];
    share_sums_[k] += sum;
  }
  // V += shares * rows: a linear layer whose inputs are the block's rows.
  kernels_.pack_rows(rows, count, layer_.channels(), packed_);
  LinearLayer gather;
  gather.p.inputs = kBlockRows;
  gather.p.outputs = layer_.channels();
  gather.p.weights = {packed_, PackedBytes(layer_.channels(), kBlockRows)};
  gather.p.bias = no_bias_;
  kernels_.linear_sums(gather, shares_, clusters, block_sums_.data());
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += block_sums_[i];
  return Status::kOk;
}

Status NetVlad::Finish(std::int8_t* out) {
  if (rows_ == 0) return Status::kEmpty;
  const std::size_t channels = layer_.channels();
  const auto residual = [&](std::size_t k, std::size_t c) {
    return static_cast<float>(sums_[k * SumStride(channels) + c]) -
           static_cast<float>(share_sums_[k]) * layer_.centres[k * channels + c];
  };
  float all = 0;
  std::array<float, kMaxClusters> factor{};
  for (std::size_t k = 0; k < layer_.clusters(); ++k) {
    float squares = 0;
    for (std::size_t c = 0; c < channels; ++c) squares += residual(k, c) * residual(k, c);
    if (squares <= 0) continue;
    factor[k] = 1.0F / std::sqrt(squares);
    all += 1.0F;
  }
  // Every cluster that is not empty has length 1 now, so the length of all is the root of their number.
  const float to_output = all > 0 ? 1.0F / (std::sqrt(all) * layer_.output_scale) : 0.0F;
  for (std::size_t k = 0; k < layer_.clusters(); ++k) {
    for (std::size_t c = 0; c < channels; ++c) *out++ = ToInt8(residual(k, c) * (factor[k] * to_output));
  }
  return Status::kOk;
}

}  // namespace mapweld::nn
