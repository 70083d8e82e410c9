// SPDX-License-Identifier: Apache-2.0
#include "core/nn/linear.hpp"

#include <gtest/gtest.h>

#include <array>

#include "core/nn/kernels.hpp"
#include "tests/support/test_layer.hpp"

namespace mapweld::nn {
namespace {

// The definition, without packing.
std::int64_t Sum(const TestLayer& layer, const std::int8_t* row, std::size_t n) {
  const LinearParameters& p = layer.parameters;
  std::int64_t sum = p.bias[n];
  for (std::size_t k = 0; k < p.inputs; ++k) sum += row[k] * p.weights[TestLayer::Index(n, k, p.inputs)];
  return sum;
}

TEST(Requantize, RoundsHalvesUpAndClamps) {
  constexpr std::int32_t kHalf = 1 << 30;  // with shift 32: a quarter
  EXPECT_EQ(Requantize(1, kHalf, 32, -127), 0);
  EXPECT_EQ(Requantize(2, kHalf, 32, -127), 1);
  EXPECT_EQ(Requantize(-2, kHalf, 32, -127), 0);
  EXPECT_EQ(Requantize(-3, kHalf, 32, -127), -1);
  EXPECT_EQ(Requantize(-6, kHalf, 32, -127), -1);
  EXPECT_EQ(Requantize(-3, kHalf, 32, 0), 0);
  EXPECT_EQ(Requantize(2147483647, 2147483647, 32, 0), 127);
  EXPECT_EQ(Requantize(-2147483647 - 1, 2147483647, 32, -127), -127);
  EXPECT_EQ(Requantize(2147483647, 2147483647, 62, 0), 1);
}

TEST(Linear, ReferenceFollowsItsDefinition) {
  std::mt19937 random(1);
  for (const std::size_t inputs : {1U, 3U, 4U, 30U}) {
    for (const std::size_t outputs : {1U, 5U, 8U, 21U}) {
      const TestLayer test(inputs, outputs, Fill::kRandom, -127, &random);
      const LinearLayer layer = test.layer();
      const auto rows = TestRows(3, inputs, -127, false, &random);
      std::vector<std::int8_t> bytes(3 * RowStride(outputs), 99);
      std::vector<std::int32_t> sums(3 * SumStride(outputs), 99);
      LinearPortable(layer, rows.data(), 3, bytes.data());
      LinearSumsPortable(layer, rows.data(), 3, sums.data());
      for (std::size_t m = 0; m < 3; ++m) {
        for (std::size_t n = 0; n < SumStride(outputs); ++n) {
          const std::int64_t sum = n < outputs ? Sum(test, rows.data() + m * RowStride(inputs), n) : 0;
          EXPECT_EQ(sums[m * SumStride(outputs) + n], sum);
          if (n >= RowStride(outputs)) continue;
          EXPECT_EQ(bytes[m * RowStride(outputs) + n],
                    Requantize(static_cast<std::int32_t>(sum), layer.p.multiplier[n], layer.p.shift[n], -127));
        }
      }
    }
  }
}

// Every kernel that runs here against the reference: sizes around every block border, all kinds of numbers.
void ExpectSameBytes(std::size_t count, std::size_t inputs, std::size_t outputs, Fill fill, int lowest_row,
                     std::mt19937* random) {
  const TestLayer test(inputs, outputs, fill, lowest_row == 0 ? 0 : -127, random);
  const LinearLayer layer = test.layer();
  EXPECT_TRUE(fill != Fill::kNarrow || layer.narrow);
  const auto rows = TestRows(count, inputs, lowest_row, fill == Fill::kExtreme, random);
  std::vector<std::int8_t> bytes(count * RowStride(outputs));
  std::vector<std::int32_t> sums(count * SumStride(outputs));
  LinearPortable(layer, rows.data(), count, bytes.data());
  LinearSumsPortable(layer, rows.data(), count, sums.data());
  for (const Kernels* kernels : AllKernels(DetectCpu())) {
    std::vector<std::int8_t> other_bytes(bytes.size() + 64, 99);  // and writes nothing behind the end
    std::vector<std::int32_t> other_sums(sums.size() + 16, 99);
    kernels->linear(layer, rows.data(), count, other_bytes.data());
    kernels->linear_sums(layer, rows.data(), count, other_sums.data());
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), other_bytes.begin()))
        << kernels->name << " " << count << " x " << inputs << " -> " << outputs << " fill " << static_cast<int>(fill);
    EXPECT_TRUE(std::equal(sums.begin(), sums.end(), other_sums.begin()))
        << kernels->name << " sums " << count << " x " << inputs << " -> " << outputs;
    EXPECT_TRUE(std::all_of(other_bytes.end() - 64, other_bytes.end(), [](int v) { return v == 99; })) << kernels->name;
    EXPECT_TRUE(std::all_of(other_sums.end() - 16, other_sums.end(), [](int v) { return v == 99; })) << kernels->name;
  }
}

TEST(Linear, AllKernelsGiveTheSameBytes) {
  std::mt19937 random(2);
  for (const std::size_t count : {1U, 3U, 4U, 5U, 67U}) {
    for (const std::size_t inputs : {1U, 4U, 7U, 8U, 12U, 64U, 129U}) {
      for (const std::size_t outputs : {1U, 4U, 5U, 8U, 13U, 16U, 24U, 67U}) {
        for (const Fill fill : {Fill::kRandom, Fill::kExtreme, Fill::kNarrow}) {
          ExpectSameBytes(count, inputs, outputs, fill, 0, &random);
          ExpectSameBytes(count, inputs, outputs, fill, -127, &random);
        }
      }
    }
  }
}

TEST(Linear, LongestSumsDoNotOverflow) {
  std::mt19937 random(3);
  ExpectSameBytes(2, kMaxInputs, 9, Fill::kExtreme, -127, &random);
  TestLayer test(kMaxInputs, 1, Fill::kExtreme, 0, &random);
  std::vector<std::int8_t> all(kMaxInputs, 127);
  std::vector<std::int8_t> weights(PackedBytes(1, kMaxInputs));
  for (std::size_t k = 0; k < kMaxInputs; ++k) weights[TestLayer::Index(0, k, kMaxInputs)] = 127;
  std::vector<std::int32_t> bias(8);
  bias[0] = 1 << 30;
  test.parameters.weights = weights;
  test.parameters.bias = bias;
  for (const Kernels* kernels : AllKernels(DetectCpu())) {
    std::array<std::int32_t, 8> sums{};
    kernels->linear_sums(test.layer(), all.data(), 1, sums.data());
    EXPECT_EQ(sums[0], 127 * 127 * 65536 + (1 << 30)) << kernels->name;
  }
}

TEST(MakeLinear, RefusesWhatTheKernelsCouldNotCompute) {
  std::mt19937 random(4);
  TestLayer test(5, 3, Fill::kRandom, 0, &random);
  const LinearParameters good = test.parameters;
  EXPECT_TRUE(MakeLinear(good).ok());
  const auto status_of = [&](auto change) {
    LinearParameters p = good;
    change(&p);
    return MakeLinear(p).status();
  };
  EXPECT_EQ(status_of([](auto* p) { p->inputs = 9; }), Status::kBadInput);
  EXPECT_EQ(status_of([](auto* p) { p->outputs = 0; }), Status::kBadInput);
  EXPECT_EQ(status_of([](auto* p) { p->bias = p->bias.first(3); }), Status::kBadInput);
  EXPECT_EQ(status_of([](auto* p) { p->shift = {}; }), Status::kBadInput);
  EXPECT_EQ(status_of([](auto* p) { p->lowest = -128; }), Status::kOutOfRange);
  std::vector<std::int8_t> weights(good.weights.begin(), good.weights.end());
  weights[0] = -128;
  EXPECT_EQ(status_of([&](auto* p) { p->weights = weights; }), Status::kOutOfRange);
  weights[0] = 0;
  weights[TestLayer::Index(0, 5, 5)] = 1;  // padding
  EXPECT_EQ(status_of([&](auto* p) { p->weights = weights; }), Status::kOutOfRange);
  std::vector<std::int32_t> numbers(8, 31);
  EXPECT_EQ(status_of([&](auto* p) { p->shift = numbers; }), Status::kOutOfRange);
  EXPECT_EQ(status_of([&](auto* p) { p->multiplier = numbers; }), Status::kOutOfRange);
  EXPECT_EQ(status_of([&](auto* p) { p->bias = numbers; }), Status::kOutOfRange);  // not zero behind the outputs
  numbers.assign(8, 0);
  numbers[1] = (1 << 30) + 1;
  EXPECT_EQ(status_of([&](auto* p) { p->bias = numbers; }), Status::kOutOfRange);
}

}  // namespace
}  // namespace mapweld::nn
