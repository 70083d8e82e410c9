// SPDX-License-Identifier: Apache-2.0
#include "core/nn/conv2d.hpp"

#include <gtest/gtest.h>

#include "tests/support/test_layer.hpp"

namespace mapweld::nn {
namespace {

// The definition: nothing is gathered or packed.
std::int8_t Convolve(const ConvGeometry& g, const TestLayer& test, const std::vector<std::int8_t>& image,
                     std::size_t oy, std::size_t ox, std::size_t n) {
  const LinearParameters& p = test.parameters;
  const auto half = static_cast<std::ptrdiff_t>(g.kernel / 2);
  const auto height = static_cast<std::ptrdiff_t>(g.height), width = static_cast<std::ptrdiff_t>(g.width);
  std::int32_t sum = p.bias[n];
  std::size_t k = 0;
  for (std::ptrdiff_t dy = -half; dy <= half; ++dy) {
    for (std::ptrdiff_t dx = -half; dx <= half; ++dx) {
      const std::ptrdiff_t y = static_cast<std::ptrdiff_t>(oy * g.stride_y) + dy;
      const std::ptrdiff_t x = (static_cast<std::ptrdiff_t>(ox * g.stride_x) + dx + width) % width;
      for (std::size_t c = 0; c < g.channels; ++c, ++k) {
        if (y < 0 || y >= height) continue;
        const auto pixel = static_cast<std::size_t>(y * width + x);
        sum += image[pixel * RowStride(g.channels) + c] * p.weights[TestLayer::Index(n, k, p.inputs)];
      }
    }
  }
  return Requantize(sum, p.multiplier[n], p.shift[n], p.lowest);
}

void ExpectDefinition(const ConvGeometry& g, std::size_t outputs) {
  std::mt19937 random(7);
  const TestLayer test(g.inputs(), outputs, Fill::kRandom, -127, &random);
  const auto layer = MakeConv2d(g, test.parameters);
  ASSERT_TRUE(layer.ok());
  const auto image = TestRows(g.height * g.width, g.channels, -127, false, &random);
  std::vector<std::int8_t> scratch(ConvScratchBytes(g), 55);
  for (const Kernels* kernels : AllKernels(DetectCpu())) {
    std::vector<std::int8_t> out(g.out_height() * g.out_width() * RowStride(outputs), 99);
    Conv2d(*kernels, layer.value(), image.data(), scratch, out.data());
    std::size_t at = 0;
    for (std::size_t y = 0; y < g.out_height(); ++y) {
      for (std::size_t x = 0; x < g.out_width(); ++x) {
        for (std::size_t n = 0; n < RowStride(outputs); ++n, ++at) {
          ASSERT_EQ(out[at], n < outputs ? Convolve(g, test, image, y, x, n) : 0)
              << kernels->name << " kernel " << g.kernel << " y " << y << " x " << x << " n " << n;
        }
      }
    }
  }
}

TEST(Conv2d, FollowsItsDefinitionForEveryKernelStrideAndOddSize) {
  for (const std::size_t kernel : {1U, 3U, 5U}) {
    for (const std::size_t stride_y : {1U, 2U}) {
      for (const std::size_t stride_x : {1U, 2U}) {
        ExpectDefinition({7, 10, 3, kernel, stride_y, stride_x}, 5);
        ExpectDefinition({4, 8, 8, kernel, stride_y, stride_x}, 16);
      }
    }
  }
}

TEST(Conv2d, TurningTheImageTurnsTheResult) {
  const ConvGeometry g{5, 12, 4, 3, 1, 1};
  std::mt19937 random(8);
  const TestLayer test(g.inputs(), 8, Fill::kRandom, 0, &random);
  const ConvLayer layer = MakeConv2d(g, test.parameters).value();
  const auto image = TestRows(g.height * g.width, g.channels, 0, false, &random);
  auto turned = image;
  for (std::size_t y = 0; y < g.height; ++y) {
    const auto line = turned.begin() + static_cast<std::ptrdiff_t>(y * g.width * 4);
    std::rotate(line, line + 5 * 4, line + static_cast<std::ptrdiff_t>(g.width * 4));
  }
  std::vector<std::int8_t> scratch(ConvScratchBytes(g)), a(5 * 12 * 8), b(5 * 12 * 8);
  Conv2d(PortableKernels(), layer, image.data(), scratch, a.data());
  Conv2d(PortableKernels(), layer, turned.data(), scratch, b.data());
  for (std::size_t y = 0; y < g.height; ++y) {
    const auto line = a.begin() + static_cast<std::ptrdiff_t>(y * g.width * 8);
    std::rotate(line, line + 5 * 8, line + static_cast<std::ptrdiff_t>(g.width * 8));
  }
  EXPECT_EQ(a, b);
}

TEST(MakeConv2d, RefusesGeometriesItCannotCompute) {
  std::mt19937 random(9);
  const TestLayer test(36, 8, Fill::kRandom, 0, &random);
  EXPECT_TRUE(MakeConv2d({4, 8, 4, 3, 1, 1}, test.parameters).ok());
  EXPECT_EQ(MakeConv2d({4, 8, 5, 3, 1, 1}, test.parameters).status(), Status::kBadInput);  // other inputs
  EXPECT_EQ(MakeConv2d({4, 9, 4, 3, 1, 2}, test.parameters).status(), Status::kBadInput);  // not round in x
  EXPECT_EQ(MakeConv2d({4, 8, 4, 3, 3, 1}, test.parameters).status(), Status::kBadInput);  // stride
  EXPECT_EQ(MakeConv2d({4, 2, 4, 3, 1, 1}, test.parameters).status(), Status::kBadInput);  // sees itself
  EXPECT_EQ(MakeConv2d({4, 8, 9, 2, 1, 1}, test.parameters).status(), Status::kBadInput);  // no centre
}

}  // namespace
}  // namespace mapweld::nn
