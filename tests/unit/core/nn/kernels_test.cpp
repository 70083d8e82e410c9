// SPDX-License-Identifier: Apache-2.0
#include "core/nn/kernels.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/support/test_layer.hpp"

#if defined(__x86_64__)
#define MAPWELD_TILE_TARGET "avx2"
#include "core/nn/linear_tiles_x86.hpp"
#include "core/nn/linear_vnni_dot.hpp"
#endif

namespace mapweld::nn {
namespace {

TEST(Kernels, WithoutFeaturesWhatRunsEverywhereIsChosen) {
  const Kernels& plain = ChooseKernels({});
#if defined(__aarch64__)
  EXPECT_STREQ(plain.name, "neon");
#else
  EXPECT_STREQ(plain.name, "portable");
#endif
}

// The other tests compare every kernel that runs here; this one says which these are and which are not covered.
TEST(Kernels, AreNamedOnceEachTheFastestLast) {
  std::string here;
  std::set<std::string> names;
  for (const Kernels* kernels : AllKernels(DetectCpu())) {
    EXPECT_TRUE(names.insert(kernels->name).second);
    here += std::string(" ") + kernels->name;
  }
  std::printf("kernels that run here:%s\n", here.c_str());
  EXPECT_STREQ((*AllKernels(DetectCpu()).begin())->name, "portable");
  EXPECT_STREQ(ChooseKernels(DetectCpu()).name, AllKernels(DetectCpu()).back()->name);
}

#if defined(__x86_64__)
// What vpdpbusd does, with the instructions of AVX2, so that the tiles around it are tested where the processor lacks
// it.
struct Emulated {
  MAPWELD_TILE_INLINE static __m256i Add(__m256i sum, __m256i x, __m256i w) {
    alignas(32) std::uint8_t a[32];
    alignas(32) std::int8_t b[32];
    alignas(32) std::int32_t s[8];
    _mm256_store_si256(reinterpret_cast<__m256i*>(a), x);
    _mm256_store_si256(reinterpret_cast<__m256i*>(b), w);
    _mm256_store_si256(reinterpret_cast<__m256i*>(s), sum);
    for (int i = 0; i < 32; ++i) s[i / 4] += a[i] * b[i];
    return _mm256_load_si256(reinterpret_cast<const __m256i*>(s));
  }
};

MAPWELD_TILE void EmulatedBytes(const LinearLayer& layer, const std::int8_t* rows, std::size_t count,
                                std::int8_t* out) {
  Walk<VnniDot<Emulated>>(layer, rows, count, StoreBytes(layer, out));
}
MAPWELD_TILE void EmulatedSums(const LinearLayer& layer, const std::int8_t* rows, std::size_t count,
                               std::int32_t* out) {
  Walk<VnniDot<Emulated>>(layer, rows, count, StoreSums(layer, out));
}

TEST(Kernels, VnniTilesGiveTheSameBytesWithTheInstructionEmulated) {
  if (!DetectCpu().avx2) GTEST_SKIP() << "this processor has no AVX2";
  std::mt19937 random(21);
  for (const std::size_t count : {1U, 4U, 7U, 66U}) {
    for (const std::size_t inputs : {4U, 13U, 64U}) {
      for (const std::size_t outputs : {8U, 13U, 40U}) {
        for (const int lowest : {0, -127}) {
          for (const Fill fill : {Fill::kRandom, Fill::kExtreme}) {
            const TestLayer test(inputs, outputs, fill, lowest, &random);
            const auto rows = TestRows(count, inputs, lowest, fill == Fill::kExtreme, &random);
            std::vector<std::int8_t> bytes(count * RowStride(outputs)), other_bytes(bytes.size());
            std::vector<std::int32_t> sums(count * SumStride(outputs)), other_sums(sums.size());
            LinearPortable(test.layer(), rows.data(), count, bytes.data());
            LinearSumsPortable(test.layer(), rows.data(), count, sums.data());
            EmulatedBytes(test.layer(), rows.data(), count, other_bytes.data());
            EmulatedSums(test.layer(), rows.data(), count, other_sums.data());
            EXPECT_EQ(bytes, other_bytes) << count << " x " << inputs << " -> " << outputs;
            EXPECT_EQ(sums, other_sums) << count << " x " << inputs << " -> " << outputs;
          }
        }
      }
    }
  }
}

TEST(Kernels, VnniInstructionItself) {
  const CpuFeatures cpu = DetectCpu();
  if (!cpu.avx_vnni && !cpu.avx512_vnni) {
    GTEST_SKIP()
        << "this processor has no VNNI: its kernels are compiled here and their tiles tested, the instruction is not";
  }
  EXPECT_GE(AllKernels(cpu).size(), 3U);
}
#endif

}  // namespace
}  // namespace mapweld::nn
