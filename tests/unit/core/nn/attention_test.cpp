// SPDX-License-Identifier: Apache-2.0
#include "core/nn/attention.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/nn/activation.hpp"
#include "core/nn/exponential.hpp"
#include "tests/support/test_layer.hpp"

namespace mapweld::nn {
namespace {

TEST(Exp, StaysWithinItsErrorBoundOverTheWholeRange) {
  double worst = 0;
  for (float x = -87.0F; x <= 88.0F; x += 0.000173F) {
    const double truth = std::exp(static_cast<double>(x));
    worst = std::max(worst, std::abs(static_cast<double>(Exp(x)) - truth) / truth);
  }
  RecordProperty("worst_relative_error", std::to_string(worst));
  std::printf("worst relative error %.3g\n", worst);
  EXPECT_LT(worst, 1.5e-7);
  EXPECT_EQ(Exp(0), 1.0F);
  EXPECT_EQ(Exp(-1000), Exp(-87));
  EXPECT_EQ(Exp(1000), Exp(88));
}

TEST(Exp2Down, FallsAndStaysWithinItsErrorBound) {
  for (std::int32_t d = 0; d < 5000; ++d) {
    const double truth = 32768 * std::exp2(-d / 256.0);
    EXPECT_LE(Exp2Down(d), truth * 1.0002) << d;
    EXPECT_GE(Exp2Down(d), truth * 0.9998 - 1) << d;
    EXPECT_LE(Exp2Down(d + 1), Exp2Down(d)) << d;
  }
  EXPECT_EQ(Exp2Down(0), 32768);
  EXPECT_EQ(Exp2Down(256), 16384);
  EXPECT_EQ(Exp2Down(2147483647), 0);
}

TEST(Sigmoid, IsTheRoundedFunction) {
  for (int q = -127; q <= 127; ++q) {
    EXPECT_EQ(Sigmoid(static_cast<std::int8_t>(q)), std::lround(128 / (1 + std::exp(-q / 16.0)))) << q;
  }
}

TEST(SelfAttention, FollowsEquationOne) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal(0, 0.7F);
  std::vector<float> v(64), row(64), out(64);
  for (float& x : v) x = normal(random);
  SelfAttention(v, 0.8F, row, out);
  std::vector<double> expected(v.begin(), v.end());
  for (std::size_t i = 0; i < 64; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < 64; ++j) sum += std::exp(static_cast<double>(v[i]) * static_cast<double>(v[j]));
    for (std::size_t j = 0; j < 64; ++j) {
      const double a = std::exp(static_cast<double>(v[i]) * static_cast<double>(v[j])) / sum;
      expected[j] += 0.8 * a * static_cast<double>(v[i]);
    }
  }
  for (std::size_t j = 0; j < 64; ++j) EXPECT_NEAR(static_cast<double>(out[j]), expected[j], 2e-6);
  SelfAttention(v, 0.0F, row, out);
  EXPECT_EQ(out, v);
}

TEST(SelfAttention, StandsLargeValues) {
  std::vector<float> v(8, 100.0F), row(8), out(8);
  v[3] = -1000.0F;
  SelfAttention(v, 1.0F, row, out);
  for (const float x : out) EXPECT_TRUE(std::isfinite(x));
}

TEST(Gate, WeighsEveryChannelByItsSigmoid) {
  std::mt19937 random(6);
  const TestLayer test(24, 24, Fill::kRandom, -127, &random);
  const auto v = TestRows(1, 24, -127, false, &random);
  std::vector<std::int8_t> logits(24), gate(24), out(24);
  LinearPortable(test.layer(), v.data(), 1, logits.data());
  for (const Kernels* kernels : AllKernels(DetectCpu())) {
    Gate(*kernels, test.layer(), v.data(), gate.data(), out.data());
    for (std::size_t c = 0; c < 24; ++c) {
      const double expected = v[c] / (1 + std::exp(-logits[c] / 16.0));
      EXPECT_NEAR(out[c], expected, 1.0) << kernels->name;
    }
  }
}

}  // namespace
}  // namespace mapweld::nn
