// SPDX-License-Identifier: Apache-2.0
#include "core/place/trained_code.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "core/place/column_grid.hpp"
#include "core/submap/submap.hpp"

namespace mapweld::place {
namespace {

struct Golden {
  std::vector<submap::SubmapPoint> points;
  std::vector<float> code;
  float unfamiliarity = 0;
};

template <class T>
T Take(const std::vector<char>& bytes, std::size_t* at) {
  T value;
  std::memcpy(&value, bytes.data() + *at, sizeof value);
  *at += sizeof value;
  return value;
}

// Written by tools/train/quantize.py --golden, which computes the same integers in Python.
std::vector<Golden> ReadGolden() {
  std::ifstream file(MAPWELD_VECTORS "/place/trained_code.bin", std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  std::size_t at = 0;
  std::vector<Golden> all(Take<std::uint32_t>(bytes, &at));
  for (Golden& g : all) {
    g.points.resize(Take<std::uint32_t>(bytes, &at));
    for (submap::SubmapPoint& p : g.points) {
      for (float* axis : {&p.x, &p.y, &p.z}) *axis = static_cast<float>(Take<std::int16_t>(bytes, &at)) * 0.01F;
    }
    for (int i = 0; i < kDescriptorDim; ++i) g.code.push_back(Take<float>(bytes, &at));
    g.unfamiliarity = Take<float>(bytes, &at);
  }
  return all;
}

struct Machine {
  TrainedCode code;
  ColumnGrid grid;
  PlanImage image;

  std::array<float, kDescriptorDim> Describe(const std::vector<submap::SubmapPoint>& points) {
    EXPECT_EQ(grid.Build(points, 100), Status::kOk);
    image.Build(grid);
    std::array<float, kDescriptorDim> out{};
    code.Run(image, out);
    return out;
  }
};

TEST(TrainedCode, GivesWhatTheTrainersIntegersGive) {
  const auto machine = std::make_unique<Machine>();
  ASSERT_EQ(machine->code.Open(CompiledModel(), nn::PortableKernels()), Status::kOk);
  const std::vector<Golden> all = ReadGolden();
  ASSERT_EQ(all.size(), 4U);
  for (const Golden& g : all) {
    const auto out = machine->Describe(g.points);
    double dot = 0;
    double squares = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      dot += static_cast<double>(out[i]) * static_cast<double>(g.code[i]);
      squares += static_cast<double>(out[i]) * static_cast<double>(out[i]);
    }
    EXPECT_NEAR(squares, 1, 1e-4);
    // Two features of a thousand may fall on the other side of a rounding step: Python's transforms round differently.
    EXPECT_GT(dot, 0.9999);
    EXPECT_NEAR(machine->code.familiarity().Distance(machine->image), g.unfamiliarity, 1e-3);
  }
}

TEST(TrainedCode, KnowsTheStreetsOfATownAndNotARoomOrACloudOfNoise) {
  const auto machine = std::make_unique<Machine>();
  ASSERT_EQ(machine->code.Open(CompiledModel(), nn::PortableKernels()), Status::kOk);
  const auto unfamiliarity = [&](const std::vector<submap::SubmapPoint>& points) {
    (void)machine->Describe(points);
    return machine->code.familiarity().Distance(machine->image);
  };
  for (const Golden& g : ReadGolden()) EXPECT_LT(unfamiliarity(g.points), 1) << "a street of a town held out";
  std::vector<submap::SubmapPoint> room;  // 6 x 5 m with a ceiling
  std::vector<submap::SubmapPoint> noise;
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 20; ++k) {
      const float u = 0.3F * static_cast<float>(i) - 3;
      const float v = 0.25F * static_cast<float>(k) - 2.5F;
      for (const float z : {-1.5F, 1.5F}) room.push_back({.x = u, .y = v, .z = z, .count = 1});
      for (const float side : {-1.0F, 1.0F}) {
        room.push_back({.x = u, .y = side * 2.5F, .z = 0.15F * static_cast<float>(k) - 1.5F, .count = 1});
        room.push_back({.x = side * 3, .y = v, .z = 0.15F * static_cast<float>(i) - 1.5F, .count = 1});
      }
    }
  }
  std::uint64_t dice = 1;
  const auto draw = [&] {
    dice = dice * 6364136223846793005U + 1442695040888963407U;
    return static_cast<float>(dice >> 40U) / static_cast<float>(1U << 24U) - 0.5F;
  };
  for (int i = 0; i < 20000; ++i) noise.push_back({.x = 80 * draw(), .y = 80 * draw(), .z = 10 * draw(), .count = 1});
  EXPECT_GT(unfamiliarity(room), 1);
  EXPECT_GT(unfamiliarity(noise), 1);
}

TEST(TrainedCode, GivesTheSameBytesWithEveryKernelOfThisMachine) {
  const std::vector<Golden> all = ReadGolden();
  const auto reference = std::make_unique<Machine>();
  ASSERT_EQ(reference->code.Open(CompiledModel(), nn::PortableKernels()), Status::kOk);
  for (const nn::Kernels* kernels : nn::AllKernels(nn::DetectCpu())) {
    const auto machine = std::make_unique<Machine>();
    ASSERT_EQ(machine->code.Open(CompiledModel(), *kernels), Status::kOk);
    for (const Golden& g : all) EXPECT_EQ(machine->Describe(g.points), reference->Describe(g.points)) << kernels->name;
  }
}

TEST(TrainedCode, RefusesAModelWithAFlippedBit) {
  struct alignas(64) Block {
    std::array<std::uint8_t, 64> bytes;
  };
  std::vector<Block> copy(CompiledModel().size() / 64 + 1);
  auto* bytes = reinterpret_cast<std::uint8_t*>(copy.data());
  std::memcpy(bytes, CompiledModel().data(), CompiledModel().size());
  bytes[CompiledModel().size() / 2] ^= 1U;
  const auto code = std::make_unique<TrainedCode>();
  EXPECT_EQ(code->Open({bytes, CompiledModel().size()}, nn::PortableKernels()), Status::kCrc);
}

}  // namespace
}  // namespace mapweld::place
