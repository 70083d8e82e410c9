// SPDX-License-Identifier: Apache-2.0
// The memory plan of a network, made by the compiler: where each intermediate result lies in one static buffer. Results
// that are never alive at the same time share their bytes.
//
//   constexpr auto kPlan = PlanArena(std::array{Buffer{64 * 1024, 0, 1}, Buffer{32 * 1024, 1, 2}});
//   alignas(kArenaAlignment) std::array<std::int8_t, kPlan.bytes> arena;      // kPlan.offset[i] is where buffer i
//   starts
#pragma once

#include <array>
#include <cstddef>

namespace mapweld::nn {

inline constexpr std::size_t kArenaAlignment = 64;

struct Buffer {
  std::size_t bytes = 0;
  int first_step = 0;  // the step that writes it
  int last_step = 0;   // the last step that reads it
};

template <std::size_t N>
struct ArenaPlan {
  std::array<std::size_t, N> offset{};
  std::size_t bytes = 0;  // of the whole arena
};

// The largest first, each at the lowest place that is free during its life. Not always the optimum; never less than the
// largest sum of what is alive at once.
template <std::size_t N>
constexpr ArenaPlan<N> PlanArena(const std::array<Buffer, N>& buffers) {
  const auto end = [](std::size_t offset, const Buffer& b) {
    return offset + (b.bytes + kArenaAlignment - 1) / kArenaAlignment * kArenaAlignment;
  };
  const auto together = [](const Buffer& a, const Buffer& b) {
    return a.first_step <= b.last_step && b.first_step <= a.last_step;
  };
  ArenaPlan<N> plan;
  std::array<bool, N> placed{};
  for (std::size_t round = 0; round < N; ++round) {
    std::size_t next = N;
    for (std::size_t i = 0; i < N; ++i) {
      if (!placed[i] && (next == N || buffers[i].bytes > buffers[next].bytes)) next = i;
    }
    std::size_t at = 0;
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t i = 0; i < N; ++i) {
        const bool apart = end(at, buffers[next]) <= plan.offset[i] || end(plan.offset[i], buffers[i]) <= at;
        if (!placed[i] || apart || !together(buffers[i], buffers[next])) continue;
        at = end(plan.offset[i], buffers[i]);
        moved = true;
      }
    }
    plan.offset[next] = at;
    placed[next] = true;
    if (end(at, buffers[next]) > plan.bytes) plan.bytes = end(at, buffers[next]);
  }
  return plan;
}

}  // namespace mapweld::nn
