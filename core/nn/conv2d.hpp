// SPDX-License-Identifier: Apache-2.0
// Convolution of an image that is round in x (azimuth, direction) and ends in y (zeros beyond). Channels last.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/status.hpp"
#include "core/nn/kernels.hpp"
#include "core/nn/linear.hpp"

namespace mapweld::nn {

struct ConvGeometry {
  std::size_t height = 0;
  std::size_t width = 0;
  std::size_t channels = 0;
  std::size_t kernel = 3;    // 1, 3 or 5, the same in x and y, centred
  std::size_t stride_y = 1;  // 1 or 2; output y looks at input y * stride_y +- kernel / 2
  std::size_t stride_x = 1;  // 1 or 2; must divide the width

  [[nodiscard]] constexpr std::size_t inputs() const { return kernel * kernel * channels; }
  [[nodiscard]] constexpr std::size_t out_height() const { return (height + stride_y - 1) / stride_y; }
  [[nodiscard]] constexpr std::size_t out_width() const { return width / stride_x; }
};

// Output positions whose inputs are laid side by side before the layer runs over them: few enough for the nearest
// caches.
inline constexpr std::size_t kConvBlock = 32;
constexpr std::size_t ConvScratchBytes(const ConvGeometry& g) {
  return kConvBlock * RowStride(g.inputs());
}

struct ConvLayer {
  ConvGeometry geometry;
  LinearLayer linear;
};
// parameters.inputs = kernel * kernel * channels, in the order ky, kx, c. kBadInput: a geometry outside the limits
// above, or that does not fit the parameters; else as MakeLinear().
Result<ConvLayer> MakeConv2d(const ConvGeometry& geometry, const LinearParameters& parameters);

// image: [height][width][RowStride(channels)]; out: [out_height][out_width][RowStride(outputs)].
// scratch: ConvScratchBytes(geometry), whatever is in it. 2 * outputs * inputs operations per output position.
void Conv2d(const Kernels& kernels, const ConvLayer& layer, const std::int8_t* image, std::span<std::int8_t> scratch,
            std::int8_t* out);

}  // namespace mapweld::nn
