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

TEST(TrainedCode, KnowsTheStreetsOfATownAndNeitherACorridorNorAHallNorAnEmptyField) {
  const auto machine = std::make_unique<Machine>();
  ASSERT_EQ(machine->code.Open(CompiledModel(), nn::PortableKernels()), Status::kOk);
  const auto unfamiliarity = [&](const std::vector<submap::SubmapPoint>& points) {
    (void)machine->Describe(points);
    return machine->code.familiarity().Distance(machine->image);
  };
  for (const Golden& g : ReadGolden()) EXPECT_LT(unfamiliarity(g.points), 1) << "a street of a town held out";
  // Floor, ceiling and walls 3 m apart; floor and ceiling alone; the floor alone, a little rough.
  std::vector<submap::SubmapPoint> corridor;
  std::vector<submap::SubmapPoint> hall;
  std::vector<submap::SubmapPoint> field;
  const auto add = [](float x, float y, float z, std::vector<submap::SubmapPoint>* to) {
    to->push_back({.x = x, .y = y, .z = z, .count = 1});
  };
  for (int i = -80; i < 80; ++i) {
    const float x = 0.5F * static_cast<float>(i);
    for (int k = -3; k <= 3; ++k) {
      const float t = 0.5F * static_cast<float>(k);
      for (const float side : {-1.5F, 1.5F}) {
        add(x, side, t, &corridor);
        add(x, t, side, &corridor);
      }
    }
    for (int k = -60; k < 60; ++k) {
      const float y = 0.5F * static_cast<float>(k);
      for (const float side : {-1.5F, 1.5F}) add(x, y, side, &hall);
      add(x, y, -1.5F + 0.04F * static_cast<float>((7 * i + 3 * k) % 3), &field);
    }
  }
  EXPECT_GT(unfamiliarity(corridor), 1);
  EXPECT_GT(unfamiliarity(hall), 1);
  EXPECT_GT(unfamiliarity(field), 1);
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
