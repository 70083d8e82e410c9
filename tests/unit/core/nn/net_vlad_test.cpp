// SPDX-License-Identifier: Apache-2.0
#include "core/nn/net_vlad.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/nn/exponential.hpp"
#include "tests/support/test_layer.hpp"

namespace mapweld::nn {
namespace {

constexpr std::size_t kRows = 300;

// A layer whose logits are within about +-3, with centres among the rows.
class TestVlad {
 public:
  TestVlad(std::size_t channels, std::size_t clusters)
      : random_(11),
        assign_(channels, clusters, Fill::kRandom, -127, &random_),
        multiplier_(SumStride(clusters), 1 << 30),
        shift_(SumStride(clusters), 32 + 7),
        centres_(channels * clusters) {
    std::uniform_real_distribution<float> centre(0, 60);
    for (float& c : centres_) c = centre(random_);
    parameters.assign = assign_.parameters;
    parameters.assign.multiplier = parameters.assign.shift = {};
    parameters.logit = {multiplier_, shift_};
    parameters.centres = centres_;
    parameters.output_scale = 1.0F / 512;
    rows = TestRows(kRows, channels, 0, false, &random_);
  }
  NetVladParameters parameters;
  std::vector<std::int8_t> rows;

 private:
  std::mt19937 random_;
  TestLayer assign_;
  std::vector<std::int32_t> multiplier_, shift_;
  std::vector<float> centres_;
};

std::vector<std::int8_t> Pool(const Kernels& kernels, const TestVlad& test, std::size_t block) {
  const NetVladLayer layer = MakeNetVlad(test.parameters).value();
  std::vector<std::int32_t> memory(NetVlad::Words(layer.channels(), layer.clusters()), 0x55555555);
  NetVlad vlad(layer, kernels, memory);
  for (std::size_t m = 0; m < kRows; m += block) {
    const auto status = vlad.AddBlock(test.rows.data() + m * RowStride(layer.channels()), std::min(block, kRows - m));
    EXPECT_EQ(status, Status::kOk);
  }
  std::vector<std::int8_t> out(layer.channels() * layer.clusters());
  EXPECT_EQ(vlad.Finish(out.data()), Status::kOk);
  return out;
}

// NetVLAD in double, from its formula.
std::vector<double> Reference(const TestVlad& test) {
  const NetVladParameters& p = test.parameters;
  const std::size_t channels = p.assign.inputs, clusters = p.assign.outputs;
  std::vector<double> v(channels * clusters);
  for (std::size_t m = 0; m < kRows; ++m) {
    const std::int8_t* row = test.rows.data() + m * RowStride(channels);
    std::vector<double> a(clusters);
    double total = 0;
    for (std::size_t k = 0; k < clusters; ++k) {
      double sum = p.assign.bias[k];
      for (std::size_t c = 0; c < channels; ++c) sum += row[c] * p.assign.weights[TestLayer::Index(k, c, channels)];
      a[k] = std::exp2(sum * std::exp2(30 - 39) / 256);
      total += a[k];
    }
    for (std::size_t k = 0; k < clusters; ++k) {
      for (std::size_t c = 0; c < channels; ++c)
        v[k * channels + c] += a[k] / total * (row[c] - static_cast<double>(p.centres[k * channels + c]));
    }
  }
  double all = 0;
  for (std::size_t k = 0; k < clusters; ++k) {
    double squares = 0;
    for (std::size_t c = 0; c < channels; ++c) squares += v[k * channels + c] * v[k * channels + c];
    for (std::size_t c = 0; c < channels; ++c) v[k * channels + c] /= std::sqrt(squares);
    all += 1;
  }
  for (double& x : v) x /= std::sqrt(all);
  return v;
}

TEST(NetVlad, IsCloseToItsFormulaInDouble) {
  const TestVlad test(32, 16);
  const std::vector<std::int8_t> out = Pool(PortableKernels(), test, NetVlad::kBlockRows);
  const std::vector<double> reference = Reference(test);
  double dot = 0, squares = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    dot += out[i] * reference[i];
    squares += static_cast<double>(out[i]) * out[i];
  }
  EXPECT_GT(dot / std::sqrt(squares), 0.999);
  EXPECT_NEAR(std::sqrt(squares) * static_cast<double>(test.parameters.output_scale), 1.0, 0.01);
}

TEST(NetVlad, DoesNotDependOnTheBlocksOrTheKernel) {
  for (const auto& [channels, clusters] : {std::pair{32U, 16U}, {20U, 5U}, {7U, 1U}, {128U, 64U}, {36U, 24U}}) {
    const TestVlad test(channels, clusters);
    const std::vector<std::int8_t> out = Pool(PortableKernels(), test, NetVlad::kBlockRows);
    for (const Kernels* kernels : AllKernels(DetectCpu())) {
      EXPECT_EQ(Pool(*kernels, test, 64), out) << kernels->name << " " << channels << " " << clusters;
      EXPECT_EQ(Pool(*kernels, test, 7), out) << kernels->name << " " << channels << " " << clusters;
    }
  }
}

TEST(NetVlad, WithoutRowsThereIsNoPlace) {
  const TestVlad test(32, 16);
  const NetVladLayer layer = MakeNetVlad(test.parameters).value();
  std::vector<std::int32_t> memory(NetVlad::Words(32, 16));
  NetVlad vlad(layer, PortableKernels(), memory);
  std::vector<std::int8_t> out(32 * 16, 3);
  EXPECT_EQ(vlad.AddBlock(test.rows.data(), 0), Status::kOk);
  EXPECT_EQ(vlad.Finish(out.data()), Status::kEmpty);
  EXPECT_EQ(vlad.AddBlock(test.rows.data(), 64), Status::kOk);
  EXPECT_EQ(vlad.Finish(out.data()), Status::kOk);
  vlad.Begin();
  EXPECT_EQ(vlad.Finish(out.data()), Status::kEmpty);
}

TEST(NetVlad, StopsBeforeItsSumsOverflow) {
  const TestVlad test(32, 16);
  const NetVladLayer layer = MakeNetVlad(test.parameters).value();
  std::vector<std::int32_t> memory(NetVlad::Words(32, 16));
  NetVlad vlad(layer, ChooseKernels(DetectCpu()), memory);
  for (std::size_t m = 0; m < NetVlad::kMaxRows; m += 64) ASSERT_EQ(vlad.AddBlock(test.rows.data(), 64), Status::kOk);
  EXPECT_EQ(vlad.AddBlock(test.rows.data(), 1), Status::kFull);
}

TEST(SoftAssign, SharesSumUpToTheWholeInEveryKernel) {
  std::mt19937 random(12);
  std::uniform_int_distribution<std::int32_t> any(-2147483647, 2147483647), small(-3000, 3000);
  for (const std::size_t clusters : {1U, 3U, 8U, 30U, 64U}) {
    const std::vector<std::int32_t> multiplier(SumStride(clusters), 1 << 30), shift(SumStride(clusters), 32);
    std::vector<std::int32_t> sums(64 * SumStride(clusters));
    for (std::size_t i = 0; i < sums.size(); ++i)
      sums[i] = i / SumStride(clusters) % 2 == 0 ? any(random) : small(random);
    std::vector<std::int8_t> shares(clusters * 64, -1);
    SoftAssignPortable({multiplier, shift}, clusters, sums.data(), 61, shares.data(), 64);
    for (std::size_t m = 0; m < 61; ++m) {
      int sum = 0;
      for (std::size_t k = 0; k < clusters; ++k) {
        EXPECT_GE(shares[k * 64 + m], 0);
        sum += shares[k * 64 + m];
      }
      EXPECT_NEAR(sum, kWholeShare, static_cast<double>(clusters) / 2);
    }
    for (const Kernels* kernels : AllKernels(DetectCpu())) {
      std::vector<std::int8_t> other(clusters * 64, -1);
      kernels->soft_assign({multiplier, shift}, clusters, sums.data(), 61, other.data(), 64);
      EXPECT_EQ(other, shares) << kernels->name << " " << clusters;
    }
  }
}

TEST(PackRows, IsTheSameInEveryKernel) {
  std::mt19937 random(13);
  for (const std::size_t channels : {1U, 4U, 8U, 12U, 16U, 31U, 40U, 128U}) {
    for (const std::size_t count : {1U, 4U, 30U, 64U}) {
      const auto rows = TestRows(count, channels, -127, false, &random);
      std::vector<std::int8_t> packed(PackedRowsBytes(channels), 99);
      PackRowsPortable(rows.data(), count, channels, packed.data());
      for (std::size_t m = 0; m < kPackedRows; ++m) {
        for (std::size_t c = 0; c < SumStride(channels); ++c) {
          const int expected = m < count && c < channels ? rows[m * RowStride(channels) + c] : 0;
          ASSERT_EQ(packed[TestLayer::Index(c, m, kPackedRows)], expected);
        }
      }
      for (const Kernels* kernels : AllKernels(DetectCpu())) {
        std::vector<std::int8_t> other(packed.size() + 32, 99);
        kernels->pack_rows(rows.data(), count, channels, other.data());
        EXPECT_TRUE(std::equal(packed.begin(), packed.end(), other.begin())) << kernels->name << " " << channels;
        EXPECT_EQ(other[packed.size()], 99);
      }
    }
  }
}

TEST(MakeNetVlad, RefusesWhatDoesNotFit) {
  TestVlad test(32, 16);
  const NetVladParameters good = test.parameters;
  EXPECT_TRUE(MakeNetVlad(good).ok());
  NetVladParameters p = good;
  p.centres = p.centres.first(31);
  EXPECT_EQ(MakeNetVlad(p).status(), Status::kBadInput);
  p = good;
  p.logit.shift = {};
  EXPECT_EQ(MakeNetVlad(p).status(), Status::kBadInput);
  p = good;
  p.output_scale = 0;
  EXPECT_EQ(MakeNetVlad(p).status(), Status::kOutOfRange);
  p.output_scale = std::nanf("");
  EXPECT_EQ(MakeNetVlad(p).status(), Status::kOutOfRange);
  std::vector<float> centres(good.centres.begin(), good.centres.end());
  centres[3] = std::nanf("");
  p = good;
  p.centres = centres;
  EXPECT_EQ(MakeNetVlad(p).status(), Status::kOutOfRange);
}

}  // namespace
}  // namespace mapweld::nn
