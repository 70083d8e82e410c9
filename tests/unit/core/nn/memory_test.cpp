// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/nn/arena.hpp"
#include "core/nn/pool.hpp"

namespace mapweld::nn {
namespace {

template <std::size_t N>
constexpr bool IsSound(const std::array<Buffer, N>& buffers, const ArenaPlan<N>& plan) {
  for (std::size_t i = 0; i < N; ++i) {
    if (plan.offset[i] % kArenaAlignment != 0 || plan.offset[i] + buffers[i].bytes > plan.bytes) return false;
    for (std::size_t j = 0; j < i; ++j) {
      const bool together =
          buffers[i].first_step <= buffers[j].last_step && buffers[j].first_step <= buffers[i].last_step;
      const bool apart =
          plan.offset[i] + buffers[i].bytes <= plan.offset[j] || plan.offset[j] + buffers[j].bytes <= plan.offset[i];
      if (together && !apart) return false;
    }
  }
  return true;
}

TEST(PlanArena, LetsAChainOfLayersShareTwoPlaces) {
  constexpr std::array<Buffer, 4> kChain{Buffer{1000, 0, 1}, {640, 1, 2}, {900, 2, 3}, {64, 3, 4}};
  constexpr auto kPlan = PlanArena(kChain);
  static_assert(IsSound(kChain, kPlan));
  static_assert(kPlan.bytes == 1024 + 640, "steps 1 needs both");
}

TEST(PlanArena, KeepsApartWhatIsAliveTogether) {
  constexpr std::array<Buffer, 6> kBuffers{Buffer{100, 0, 5}, {200, 1, 2}, {300, 2, 4},
                                           {200, 3, 5},       {1, 0, 0},   {0, 2, 3}};
  constexpr auto kPlan = PlanArena(kBuffers);
  static_assert(IsSound(kBuffers, kPlan));
  EXPECT_LE(kPlan.bytes, 128U + 256U + 320U + 64U);
}

TEST(Pool, TakesTheLargestAndTheRoundedMean) {
  const std::array<std::int8_t, 12> rows{1, -5, 127, 0, 2, -6, -127, 0, 4, -6, 3, 0};
  std::array<std::int8_t, 4> out{};
  std::array<std::int32_t, 4> sums{};
  MaxPool(rows.data(), 3, 3, out.data());
  EXPECT_EQ(out, (std::array<std::int8_t, 4>{4, -5, 127, 0}));
  MeanPool(rows.data(), 3, 3, sums.data(), out.data());
  EXPECT_EQ(out, (std::array<std::int8_t, 4>{2, -6, 1, 0}));  // 7/3, -17/3, 3/3
  MeanPool(rows.data(), 2, 3, sums.data(), out.data());
  EXPECT_EQ(out, (std::array<std::int8_t, 4>{2, -5, 0, 0}));  // halves go up: 1.5, -5.5, 0
}

}  // namespace
}  // namespace mapweld::nn
