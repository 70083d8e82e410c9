// SPDX-License-Identifier: Apache-2.0
// The trainer's rules in numpy and the kernels give the same bytes (tests/vectors/nn/make_vectors.py wrote the file).
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "core/nn/attention.hpp"
#include "core/nn/conv2d.hpp"
#include "core/nn/net_vlad.hpp"
#include "tests/support/made_up_model.hpp"

namespace mapweld::nn {
namespace {

std::vector<std::uint8_t> ReadFile(const char* path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

class Golden : public testing::Test {
 protected:
  Golden() : file_(ReadFile(MAPWELD_VECTORS "/layers.mwm")) {}
  void SetUp() override { ASSERT_EQ(model_.Open(file_.bytes()), Status::kOk) << BlobFaultName(model_.fault()); }

  template <class T>
  std::vector<T> Get(const std::string& name, const Shape& shape) {
    const auto tensor = model_.Find<T>(name, shape);
    EXPECT_TRUE(tensor.ok()) << name << ": " << StatusName(tensor.status());
    if (!tensor.ok()) return {};
    return {tensor.value().begin(), tensor.value().end()};
  }
  template <class T>
  std::span<const T> View(const std::string& name, const Shape& shape) {
    return model_.Find<T>(name, shape).value();
  }
  LinearParameters Parameters(const std::string& name, std::uint32_t inputs, std::uint32_t outputs, int lowest) {
    const Shape packed{(outputs + 7) / 8, (inputs + 3) / 4, 8, 4};
    const Shape padded{(outputs + 7) / 8 * 8};
    return {inputs,
            outputs,
            View<std::int8_t>(name + ".weight", packed),
            View<std::int32_t>(name + ".bias", padded),
            View<std::int32_t>(name + ".multiplier", padded),
            View<std::int32_t>(name + ".shift", padded),
            lowest};
  }

 private:
  AlignedCopy file_;
  ModelBlob model_;
};

TEST_F(Golden, Linear) {
  for (const auto& [name, lowest] : {std::pair{std::string("relu"), 0}, {std::string("signed"), -127}}) {
    const LinearLayer layer = MakeLinear(Parameters(name, 37, 21, lowest)).value();
    EXPECT_TRUE(layer.narrow) << "the trainer's quantiser keeps sums narrow";
    const auto x = Get<std::int8_t>(name + ".x", {9, 40});
    for (const Kernels* kernels : AllKernels(DetectCpu())) {
      std::vector<std::int32_t> sums(9 * 24);
      std::vector<std::int8_t> y(9 * 24);
      kernels->linear_sums(layer, x.data(), 9, sums.data());
      kernels->linear(layer, x.data(), 9, y.data());
      EXPECT_EQ(sums, Get<std::int32_t>(name + ".sums", {9, 24})) << kernels->name;
      EXPECT_EQ(y, Get<std::int8_t>(name + ".y", {9, 24})) << kernels->name;
    }
  }
}

TEST_F(Golden, Conv2d) {
  const auto x = Get<std::int8_t>("conv.x", {7, 10, 4});
  for (const auto& [stride, y] :
       {std::pair{1U, Get<std::int8_t>("conv.y", {7, 10, 8})}, {2U, Get<std::int8_t>("conv.y_strided", {4, 5, 8})}}) {
    const ConvLayer layer = MakeConv2d({7, 10, 4, 3, stride, stride}, Parameters("conv", 36, 8, 0)).value();
    std::vector<std::int8_t> scratch(ConvScratchBytes(layer.geometry)), out(y.size());
    Conv2d(ChooseKernels(DetectCpu()), layer, x.data(), scratch, out.data());
    EXPECT_EQ(out, y) << stride;
  }
}

TEST_F(Golden, NetVlad) {
  NetVladParameters p;
  p.assign = Parameters("vlad", 24, 10, -127);
  p.logit = {p.assign.multiplier, p.assign.shift};
  p.assign.multiplier = p.assign.shift = {};
  p.centres = View<float>("vlad.centres", {10, 24});
  p.output_scale = 1.0F / 512;
  const NetVladLayer layer = MakeNetVlad(p).value();
  const auto x = Get<std::int8_t>("vlad.x", {150, 24});
  for (const Kernels* kernels : AllKernels(DetectCpu())) {
    std::vector<std::int32_t> memory(NetVlad::Words(24, 10));
    NetVlad vlad(layer, *kernels, memory);
    for (std::size_t m = 0; m < 150; m += 64) {
      ASSERT_EQ(vlad.AddBlock(x.data() + m * 24, std::min<std::size_t>(64, 150 - m)), Status::kOk);
    }
    std::vector<std::int8_t> y(10 * 24);
    ASSERT_EQ(vlad.Finish(y.data()), Status::kOk);
    EXPECT_EQ(y, Get<std::int8_t>("vlad.y", {10, 24})) << kernels->name;
  }
}

TEST_F(Golden, Attention) {
  const auto x = Get<float>("attention.x", {32});
  std::vector<float> row(32), y(32);
  SelfAttention(x, 0.7F, row, y);
  EXPECT_EQ(y, Get<float>("attention.y", {32})) << "to the last bit";
}

TEST_F(Golden, Gate) {
  const LinearLayer layer = MakeLinear(Parameters("gate", 16, 16, -127)).value();
  const auto x = Get<std::int8_t>("gate.x", {16});
  std::vector<std::int8_t> gate(16), y(16);
  Gate(ChooseKernels(DetectCpu()), layer, x.data(), gate.data(), y.data());
  EXPECT_EQ(y, Get<std::int8_t>("gate.y", {16}));
}

}  // namespace
}  // namespace mapweld::nn
