// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/bench_tools.hpp"

#include <algorithm>
#include <ctime>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace mapweld::bench {
namespace {

constexpr int kRounds = 4'000'000;

#if defined(__x86_64__)
[[gnu::target("avx2")]] double Avx2Ops() {
  constexpr int kSums = 12;
  __m256i sum[kSums];
  const __m256i b = _mm256_set1_epi16(3);
#pragma GCC unroll 12
  for (auto& s : sum) s = _mm256_set1_epi16(1);
  for (int i = 0; i < kRounds; ++i) {
#pragma GCC unroll 12
    for (auto& s : sum) {
      s = _mm256_add_epi32(s, _mm256_madd_epi16(s, b));
      asm volatile("" : "+x"(s));
    }
  }
  return 32.0 * kSums * kRounds;
}

[[gnu::target("avx512f,avx512vnni")]] double VnniOps() {
  constexpr int kSums = 24;
  __m512i sum[kSums];
  const __m512i b = _mm512_set1_epi8(3);
#pragma GCC unroll 24
  for (auto& s : sum) s = _mm512_set1_epi8(1);
  for (int i = 0; i < kRounds; ++i) {
#pragma GCC unroll 24
    for (auto& s : sum) {
      s = _mm512_dpbusd_epi32(s, b, b);
      asm volatile("" : "+v"(s));
    }
  }
  return 128.0 * kSums * kRounds;
}
#endif

}  // namespace

double CpuSeconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double CeilingOpsPerSecond(std::string_view kernel) {
  const double begin_s = CpuSeconds();
  double ops = 0;
#if defined(__x86_64__)
  if (kernel == "avx2") ops = Avx2Ops();
  if (kernel == "avx512-vnni") ops = VnniOps();
#endif
  return ops / (CpuSeconds() - begin_s);
}

}  // namespace mapweld::bench
