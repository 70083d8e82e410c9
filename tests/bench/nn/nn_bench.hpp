// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <ctime>
#include <functional>
#include <vector>

namespace mapweld::bench {

// CPU time of this process, seconds.
inline double CpuSeconds() {
  std::timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

using Work = std::function<void()>;

// 32 products and their addition to 32-bit sums per step of a loop that does nothing else; the number of operations.
double RunInt8Ceiling();

// The same layer in XNNPACK (one thread, int8 with one scale); empty where it is not installed.
Work XnnpackLinear(std::size_t count, std::size_t inputs, std::size_t outputs);
Work XnnpackConv(std::size_t height, std::size_t width, std::size_t channels, std::size_t kernel, std::size_t outputs);

}  // namespace mapweld::bench
