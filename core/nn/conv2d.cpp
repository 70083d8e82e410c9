// SPDX-License-Identifier: Apache-2.0
#include "core/nn/conv2d.hpp"

#include <algorithm>
#include <cstring>

#include "core/base/assert.hpp"

namespace mapweld::nn {
namespace {

bool InLimits(const ConvGeometry& g) {
  return g.height > 0 && g.width >= g.kernel && g.channels > 0 && (g.kernel == 1 || g.kernel == 3 || g.kernel == 5) &&
         (g.stride_y == 1 || g.stride_y == 2) && (g.stride_x == 1 || g.stride_x == 2) && g.width % g.stride_x == 0;
}

// One row of the kernel: `kernel` neighbouring pixels from x on, around the border if need be.
void GatherPixels(const ConvGeometry& g, const std::int8_t* line, std::size_t x, std::int8_t* to) {
  const std::size_t stride = RowStride(g.channels);
  if (stride == g.channels && x + g.kernel <= g.width) {
    std::memcpy(to, line + x * stride, g.kernel * stride);
    return;
  }
  for (std::size_t kx = 0; kx < g.kernel; ++kx, to += g.channels) {
    const std::size_t from = x + kx < g.width ? x + kx : x + kx - g.width;
    std::memcpy(to, line + from * stride, g.channels);
  }
}

// What the kernel sees at one output position.
void Gather(const ConvGeometry& g, const std::int8_t* image, std::size_t out_y, std::size_t out_x, std::int8_t* row) {
  const std::size_t half = g.kernel / 2;
  const std::size_t x = out_x * g.stride_x;
  const std::size_t first_x = x >= half ? x - half : x + g.width - half;
  for (std::size_t ky = 0; ky < g.kernel; ++ky) {
    const std::size_t y = out_y * g.stride_y + ky;  // + half
    std::int8_t* to = row + ky * g.kernel * g.channels;
    if (y < half || y - half >= g.height) {
      std::memset(to, 0, g.kernel * g.channels);
    } else {
      GatherPixels(g, image + (y - half) * g.width * RowStride(g.channels), first_x, to);
    }
  }
  std::memset(row + g.inputs(), 0, RowStride(g.inputs()) - g.inputs());
}

}  // namespace

Result<ConvLayer> MakeConv2d(const ConvGeometry& geometry, const LinearParameters& parameters) {
  if (!InLimits(geometry) || parameters.inputs != geometry.inputs()) return Status::kBadInput;
  const Result<LinearLayer> linear = MakeLinear(parameters);
  if (!linear.ok()) return linear.status();
  return ConvLayer{geometry, linear.value()};
}

void Conv2d(const Kernels& kernels, const ConvLayer& layer, const std::int8_t* image, std::span<std::int8_t> scratch,
            std::int8_t* out) {
  const ConvGeometry& g = layer.geometry;
  const std::size_t positions = g.out_height() * g.out_width();
  if (g.kernel == 1 && g.stride_x == 1 && g.stride_y == 1) {
    kernels.linear(layer.linear, image, positions, out);
    return;
  }
  MAPWELD_ASSERT(scratch.size() >= ConvScratchBytes(g));
  for (std::size_t first = 0; first < positions; first += kConvBlock) {
    const std::size_t count = std::min(kConvBlock, positions - first);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = first + i;
      Gather(g, image, at / g.out_width(), at % g.out_width(), scratch.data() + i * RowStride(g.inputs()));
    }
    kernels.linear(layer.linear, scratch.data(), count, out + first * RowStride(layer.linear.p.outputs));
  }
}

}  // namespace mapweld::nn
